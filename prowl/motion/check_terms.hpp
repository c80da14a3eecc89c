#pragma once

#include "prowl/motion/motion_problem.hpp"

namespace prowl {

/// Throws InputError that names the field unless the terms of the problem have names of their own, frames of the
/// robot, moments of the motion, entries of the right number and size, and a fixed start keeps their limits.
void check_terms(const MotionProblem& problem);

}  // namespace prowl
