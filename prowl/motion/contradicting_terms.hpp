#pragma once

#include <string>

#include "prowl/motion/motion_problem.hpp"

namespace prowl {

/// Two limits of the problem that no motion keeps, as they ask for different values of one quantity at one time:
/// "terms 'a' and 'b' contradict each other: ...". Empty if there are none.
std::string contradicting_terms(const MotionProblem& problem);

}  // namespace prowl
