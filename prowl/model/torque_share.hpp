#pragma once

#include <cmath>
#include <limits>

#include "prowl/model/robot_model.hpp"

namespace prowl {

/// Torque of a joint over its limit in that direction at this position [rad, m] and velocity [rad/s, m/s]; infinite if
/// that limit is not positive.
inline double torque_share(const RobotModel& robot, int joint, double position, double velocity, double torque) {
  const double most =
      torque > 0.0 ? robot.torque_upper(joint, position, velocity) : -robot.torque_lower(joint, position, velocity);
  if (most > 0.0) return std::abs(torque) / most;
  return torque == 0.0 ? 0.0 : std::numeric_limits<double>::infinity();
}

}  // namespace prowl
