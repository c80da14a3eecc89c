#pragma once

#include <string>
#include <vector>

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
  /// Why there can be no such motion, proven before the solve (proofs_of_infeasibility). If there is a reason the status is
  /// infeasible, the solver did not run, and the trajectory is the initial guess.
  std::vector<std::string> reasons;
  /// After a solve that did not converge: what may be the matter (doubts).
  std::vector<std::string> hints;
};

/// The whole way from a problem to a certified motion. Throws InputError if the problem makes no sense, NumericalError
/// if the model cannot be evaluated at the initial guess; a problem that is too hard is a status in the result.
Plan make_plan(const MotionProblem& problem, const NlpSolver& solver, const SolverOptions& options);

}  // namespace prowl
