#include "prowl/motion/disturbances.hpp"

#include <cmath>

namespace prowl {

Disturbances default_disturbances(const RobotModel& robot) {
  constexpr double kHeight = 0.58;  // [m]; of the robot of which the sizes speak
  const double height = robot.nominal_configuration().z() / kHeight, speed = std::sqrt(height);
  return {.base_position = 0.01 * height,
          .base_angle = 0.02,
          .base_velocity = 0.05 * speed,
          .base_rate = 0.1,
          .mass = 0.1,
          .center = 0.02 * height,
          .friction = 0.2,
          .push = 0.12 * speed};
}

}  // namespace prowl
