#pragma once

#include "prowl/nlp/nlp_solver.hpp"

namespace prowl {

/// Prowl's own solver for chains of stages: the interior point method of InteriorPoint with the exact Hessian, whose
/// linear systems StageKkt solves by a Riccati recursion. docs/solvers.md.
///
/// - Takes problems with a stage-wise form only (Nlp::stagewise).
/// - `converged` means that the dual equations and the complementarity (scaled as in Wächter and Biegler 2006, eq. (5))
/// and
///   the constraints are within tolerance in units of the stages, and the constraints as the Nlp sees them too.
/// - A value that is not finite at a trial point shortens the step; a derivative that is not ends the solve as
///   `evaluation_failed`. Limits and interrupts are looked at once an iteration.
/// - Stopped early, it returns its best iterate, as IpoptSolver does. Multipliers are given by stages, if it converged.
/// - Fixed order of operations: same problem, same start, same machine, same iterates.
class RiccatiSolver : public NlpSolver {
 public:
  std::string name() const override;
  std::string version() const override;
  std::optional<std::string> why_unsupported(Nlp& nlp) const override;
  /// Throws InputError only if an option or the size of z_start makes no sense.
  SolveResult solve(Nlp& nlp, const Eigen::VectorXd& z_start, const SolverOptions& options) const override;
};

}  // namespace prowl
