#pragma once

#include <vector>

#include "prowl/diagnosis/adjustable_parameter.hpp"

namespace prowl {

/// Parameters of the task's demands: goals away from the start, nearer; footholds of landings, nearer to the contact's
/// previous position if that is known; swing clearance, lower. They refer to the problem, which must outlive them.
std::vector<AdjustableParameter> asked_parameters(const MotionProblem& problem);

}  // namespace prowl
