#pragma once

#include "prowl/motion/motion_problem.hpp"
#include "prowl/nlp/nlp_solver.hpp"
#include "prowl/trajectory/certificate.hpp"
#include "prowl/trajectory/trajectory.hpp"

namespace prowl {

/// What comes out: a motion, how it was found, and whether it is any good.
struct Plan {
  Trajectory trajectory;
  SolveResult result;
  Certificate certificate;
  int num_variables = 0;
  int num_constraints = 0;
};

/// The whole way from a problem to a certified motion. Throws InputError if the problem makes no sense, NumericalError
/// if the model cannot be evaluated at the initial guess; a problem that is too hard is a status in the result.
Plan make_plan(const MotionProblem& problem, const NlpSolver& solver, const SolverOptions& options);

}  // namespace prowl
