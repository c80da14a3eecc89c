#include "prowl/tracking/tracking_options.hpp"

#include <cmath>

namespace prowl {

TrackingOptions default_tracking_options(const RobotModel& robot) {
  const int nv = robot.nv();
  constexpr DefaultDeviations deviations;
  TrackingOptions options;
  options.state_deviation.resize(2 * nv);
  options.state_deviation.segment<3>(0).setConstant(deviations.base_position);
  options.state_deviation.segment<3>(3).setConstant(deviations.base_orientation);
  options.state_deviation.segment(6, robot.nu()).setConstant(deviations.joint_position);
  options.state_deviation.segment<3>(nv).setConstant(deviations.base_linear_velocity);
  options.state_deviation.segment<3>(nv + 3).setConstant(deviations.base_angular_velocity);
  options.state_deviation.tail(robot.nu()).setConstant(deviations.joint_velocity);
  // Joints without a limit: the robot's weight on a lever of the robot's size.
  const double weight_torque = robot.weight() * robot.size();
  options.torque_deviation = deviations.torque_share * robot.torque_limit().unaryExpr([&](double limit) {
    return std::isfinite(limit) ? limit : weight_torque;
  });
  return options;
}

}  // namespace prowl
