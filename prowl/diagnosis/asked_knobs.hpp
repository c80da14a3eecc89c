#pragma once

#include <vector>

#include "prowl/diagnosis/change.hpp"

namespace prowl {

/// Knobs of how far the robot has to go: each goal that is away from the start, nearer; each place that a contact has
/// to land on, nearer to where it stood before, if that is known; the swing clearance, lower. They refer to the
/// problem, which must outlive them.
std::vector<Knob> asked_knobs(const MotionProblem& problem);

}  // namespace prowl
