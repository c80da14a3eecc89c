#include "prowl/io/task_tracking.hpp"

#include <algorithm>

namespace prowl {
namespace {

/// Deviations are squared and divided by: not so small that a weight has no meaning.
constexpr NumberRange kDeviation{.lower = 1e-6};

void read_deviation3(const TomlTable& table, const std::string& key, Eigen::Ref<Eigen::VectorXd> deviation) {
  const auto value = table.find(key);
  if (!value) return;
  if (value->is_list()) {
    deviation = value->as_vector3(kDeviation);
  } else {
    deviation.setConstant(value->as_number(kDeviation));
  }
}

void read_joint_deviation(const TomlTable& table, const std::string& key, const RobotModel& robot,
                          Eigen::Ref<Eigen::VectorXd> deviation) {
  const auto value = table.find(key);
  if (!value) return;
  if (!value->is_table()) {
    deviation.setConstant(value->as_number(kDeviation));
    return;
  }
  const std::vector<std::string>& names = robot.joint_names();
  for (const auto& [name, entry] : value->as_named_values(names, "joint")) {
    deviation(std::find(names.begin(), names.end(), name) - names.begin()) = entry.as_number(kDeviation);
  }
}

}  // namespace

TrackingOptions read_tracking(const TomlTable& root, const RobotModel& robot) {
  TrackingOptions options = default_tracking_options(robot);
  const auto table = root.find_table("tracking");
  if (!table) return options;
  const int nv = robot.nv(), nu = robot.nu();
  if (const auto value = table->find("step_s")) options.step = value->as_number({.lower = 1e-4, .upper = 0.1});
  Eigen::VectorXd& deviation = options.state_deviation;
  read_deviation3(*table, "base_position_m", deviation.segment(0, 3));
  read_deviation3(*table, "base_orientation_rad", deviation.segment(3, 3));
  read_joint_deviation(*table, "joint_position_rad", robot, deviation.segment(6, nu));
  read_deviation3(*table, "base_linear_velocity_mps", deviation.segment(nv, 3));
  read_deviation3(*table, "base_angular_velocity_radps", deviation.segment(nv + 3, 3));
  read_joint_deviation(*table, "joint_velocity_radps", robot, deviation.tail(nu));
  if (const auto value = table->find("torque_share")) {
    options.torque_deviation *= value->as_number(kDeviation) / TrackingOptions::kTorqueShare;
  }
  if (const auto value = table->find("landing_s")) options.landing_time = value->as_number(NumberRange::nonnegative());
  if (const auto value = table->find("bandwidth_radps")) options.largest_bandwidth = value->as_number(NumberRange::positive());
  return options;
}

}  // namespace prowl
