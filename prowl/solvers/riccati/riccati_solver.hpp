#pragma once

#include "prowl/nlp/nlp_solver.hpp"

namespace prowl {

/// Prowl's own solver for chains of stages: InteriorPoint with the exact Hessian; StageKkt solves
/// its linear systems by a Riccati recursion. docs/solvers.md.
///
/// - Solves only problems with a stage-wise form (Nlp::stagewise).
/// - `converged`: dual equations and complementarity (scaled as in Wächter and Biegler 2006, eq. (5))
///   are within tolerance in units of the stages, the constraints there and in the Nlp.
/// - A non-finite value at a trial point shortens the step; a non-finite derivative ends the solve as
///   `evaluation_failed`. Limits and interrupts are checked once per iteration.
/// - Stopped early, it returns its best iterate, like IpoptSolver. If converged, it returns
///   multipliers by stage.
/// - Fixed order of operations: deterministic on one machine.
class RiccatiSolver : public NlpSolver {
 public:
  std::string name() const override;
  std::string version() const override;
  std::optional<std::string> why_unsupported(Nlp& nlp) const override;
  /// Throws InputError only for an invalid option or size of z_guess.
  SolveResult solve(Nlp& nlp, const Eigen::VectorXd& z_guess, const SolverOptions& options) const override;
};

}  // namespace prowl
