#pragma once

#include <string>
#include <vector>

#include "prowl/simulation/physics.hpp"

namespace prowl {

/// The model of physics.hpp as one self-contained MJCF file. Numbers have all digits, so MuJoCo
/// loads the identical model. Throws InputError with MuJoCo's reason if it rejects the robot.
std::string mujoco_xml(const RobotModel& robot, const std::vector<Surface>& surfaces, const PhysicsOptions& options);

}  // namespace prowl
