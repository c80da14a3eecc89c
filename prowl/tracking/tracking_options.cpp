#include "prowl/tracking/tracking_options.hpp"

#include <cmath>

namespace prowl {

TrackingOptions default_tracking_options(const RobotModel& robot) {
  const int nv = robot.nv();
  TrackingOptions options;
  options.state_deviation.resize(2 * nv);
  options.state_deviation.segment<3>(0).setConstant(0.02);          // base position [m]
  options.state_deviation.segment<3>(3).setConstant(0.04);          // base orientation [rad]
  options.state_deviation.segment(6, robot.nu()).setConstant(0.1);  // joints [rad]
  options.state_deviation.segment<3>(nv).setConstant(0.2);          // base velocity [m/s]
  options.state_deviation.segment<3>(nv + 3).setConstant(0.4);      // [rad/s]
  options.state_deviation.tail(robot.nu()).setConstant(10.0);       // joint rates [rad/s]
  // Where a joint has no limit: of the torque that holds the robot's weight on a lever as long as the robot.
  const double weight_torque = robot.weight() * robot.size();
  options.torque_deviation = TrackingOptions::kTorqueShare * robot.torque_limit().unaryExpr([&](double limit) {
    return std::isfinite(limit) ? limit : weight_torque;
  });
  return options;
}

}  // namespace prowl
