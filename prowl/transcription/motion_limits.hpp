#pragma once

#include <vector>

#include "prowl/transcription/node/motion_limit.hpp"
#include "prowl/transcription/node_program.hpp"

namespace prowl {

/// All that a task might have otherwise, but for durations: friction, torques, positions and velocities of joints,
/// goals, places and clearance. The start is none, and no bound that is not there.
std::vector<MotionLimit> motion_limits(const NodeProgram& program);

}  // namespace prowl
