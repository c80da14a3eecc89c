#pragma once

#include <vector>

#include "prowl/diagnosis/change.hpp"

namespace prowl {

/// Knobs of the task's demands: goals away from the start, nearer; footholds of landings, nearer to the contact's
/// previous position if that is known; swing clearance, lower. They refer to the problem, which must outlive them.
std::vector<Knob> asked_knobs(const MotionProblem& problem);

}  // namespace prowl
