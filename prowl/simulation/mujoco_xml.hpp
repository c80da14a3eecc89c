#pragma once

#include <string>
#include <vector>

#include "prowl/simulation/physics.hpp"

namespace prowl {

/// The model of physics.hpp as an MJCF file, one that needs no other file: numbers with all digits, so that MuJoCo
/// makes the same model of it. Throws InputError, with MuJoCo's reason, for a robot that it cannot have.
std::string mujoco_xml(const RobotModel& robot, const std::vector<Surface>& surfaces, const PhysicsOptions& options);

}  // namespace prowl
