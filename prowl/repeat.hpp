#pragma once

#include "prowl/plan.hpp"

namespace prowl {

/// True for a motion of several cycles: the first is planned, and repeated.
bool has_repetitions(const MotionProblem& problem);

/// The first cycle of such a motion, on its part of the mesh.
DiscreteProblem first_cycle(const DiscreteProblem& asked);

/// The options for it: of a warm start only the first cycle; no iterates, which are motions of one cycle.
PlanOptions options_of_cycle(const DiscreteProblem& asked, PlanOptions options);

/// Repeats the plan of the first cycle, and certifies the whole motion.
void repeat(const DiscreteProblem& asked, const NlpSolver& solver, const PlanOptions& options, Plan& plan);

}  // namespace prowl
