#pragma once

#include <vector>

#include "prowl/transcription/node/motion_limit.hpp"
#include "prowl/transcription/node_program.hpp"

namespace prowl {

/// All limits that a task could change, except durations: friction, torques, joint positions and
/// velocities, goals, footholds and clearance. Excludes the start and infinite bounds.
std::vector<MotionLimit> motion_limits(const NodeProgram& program);

}  // namespace prowl
