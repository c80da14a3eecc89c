#include "prowl/task_file/task_tracking.hpp"

#include "prowl/task_file/toml/toml_vectors.hpp"

namespace prowl {
TrackingOptions read_tracking(const TomlTable& root, const RobotModel& robot) {
  TrackingOptions options = default_tracking_options(robot);
  const auto table = root.find_table("tracking");
  if (!table) return options;
  const int nv = robot.nv(), nu = robot.nu();
  if (const auto value = table->find("step_s")) options.step = value->as_number();
  Eigen::VectorXd& deviation = options.state_deviation;
  read_axes(*table, "base_position_m", deviation.segment(0, 3));
  read_axes(*table, "base_orientation_rad", deviation.segment(3, 3));
  read_joints(*table, "joint_position_rad", robot, deviation.segment(6, nu));
  read_axes(*table, "base_linear_velocity_mps", deviation.segment(nv, 3));
  read_axes(*table, "base_angular_velocity_radps", deviation.segment(nv + 3, 3));
  read_joints(*table, "joint_velocity_radps", robot, deviation.tail(nu));
  if (const auto value = table->find("torque_share")) {
    options.torque_deviation *= value->as_number() / DefaultDeviations{}.torque_share;
  }
  if (const auto value = table->find("swing_foot_m")) options.swing_foot_deviation = value->as_number();
  if (const auto value = table->find("landing_s")) options.landing_time = value->as_number();
  if (const auto value = table->find("goal_s")) options.goal_time = value->as_number();
  if (const auto value = table->find("bandwidth_radps")) options.largest_bandwidth = value->as_number();
  return options;
}

}  // namespace prowl
