#include "prowl/motion/disturbances.hpp"

#include <cmath>

namespace prowl {

double height_share(const RobotModel& robot) {
  constexpr double kHeight = 0.58;  // [m]
  return robot.nominal_configuration().z() / kHeight;
}

Disturbances default_disturbances(const RobotModel& robot) {
  const double height = height_share(robot), speed = std::sqrt(height);
  Disturbances sizes = kSweptDisturbances;
  sizes.base_position *= height;
  sizes.center *= height;
  sizes.ground *= height;
  sizes.estimate_position *= height;
  sizes.base_velocity *= speed;
  sizes.push *= speed;
  return sizes;
}

}  // namespace prowl
