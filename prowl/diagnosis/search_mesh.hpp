#pragma once

#include "prowl/motion/motion_problem.hpp"

namespace prowl {

/// The problem on a mesh of about 20 intervals, 4 or more a phase: as coarse as tells whether there is a motion at all,
/// and cheap to solve again and again. Goals keep their nodes. As it is if it has no more.
MotionProblem on_search_mesh(const MotionProblem& problem);

/// A problem with the steps of another one of the same phases.
MotionProblem with_steps_of(const MotionProblem& problem, const MotionProblem& other);

}  // namespace prowl
