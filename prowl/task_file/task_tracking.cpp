#include "prowl/task_file/task_tracking.hpp"

#include "prowl/task_file/toml/toml_vectors.hpp"

namespace prowl {
namespace {

/// Deviations are squared and divided by: not so small that a weight has no meaning.
constexpr NumberRange kDeviation{.lower = 1e-6};

}  // namespace

TrackingOptions read_tracking(const TomlTable& root, const RobotModel& robot) {
  TrackingOptions options = default_tracking_options(robot);
  const auto table = root.find_table("tracking");
  if (!table) return options;
  const int nv = robot.nv(), nu = robot.nu();
  if (const auto value = table->find("step_s")) options.step = value->as_number({.lower = 1e-4, .upper = 0.1});
  Eigen::VectorXd& deviation = options.state_deviation;
  read_axes(*table, "base_position_m", kDeviation, deviation.segment(0, 3));
  read_axes(*table, "base_orientation_rad", kDeviation, deviation.segment(3, 3));
  read_joints(*table, "joint_position_rad", robot, kDeviation, deviation.segment(6, nu));
  read_axes(*table, "base_linear_velocity_mps", kDeviation, deviation.segment(nv, 3));
  read_axes(*table, "base_angular_velocity_radps", kDeviation, deviation.segment(nv + 3, 3));
  read_joints(*table, "joint_velocity_radps", robot, kDeviation, deviation.tail(nu));
  if (const auto value = table->find("torque_share")) {
    options.torque_deviation *= value->as_number(kDeviation) / TrackingOptions::kTorqueShare;
  }
  if (const auto value = table->find("landing_s")) options.landing_time = value->as_number(NumberRange::nonnegative());
  if (const auto value = table->find("bandwidth_radps"))
    options.largest_bandwidth = value->as_number(NumberRange::positive());
  return options;
}

}  // namespace prowl
