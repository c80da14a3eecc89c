#pragma once

#include "prowl/nlp/nlp_solver.hpp"

namespace prowl {

/// Uno 2.7 (Vanaret, Leyffer 2024) as filterSQP (Fletcher, Leyffer 2002): sequential quadratic
/// programming with trust region, filter and exact Hessian. BQPD (Fletcher: active set, dense in
/// the free directions) solves the quadratic programs.
///
/// - A free substitute for SNOPT: few but expensive iterations. The time of one grows with the cube of
///   the number of free directions and with the change of the active set: for meshes of about 10
///   intervals, not 100.
/// - `converged`: Uno reports a KKT point, and the point is within tolerance in the Nlp.
/// - A failed evaluation at a trial point shrinks the trust region. A failure that Uno cannot avoid
///   ends the solve as `evaluation_failed`. Limits and interrupts are checked in every product with
///   the Hessian; a quadratic program that searches a feasible point makes none, and delays them.
/// - Stopped early, it returns its best iterate, like IpoptSolver.
/// - One thread except for evaluations, fixed order of operations: deterministic on one machine.
/// - One solve at a time per process, as BQPD has global work space. Others wait.
class UnoSolver : public NlpSolver {
 public:
  std::string name() const override;
  std::string version() const override;
  std::optional<std::string> why_unsupported(Nlp& nlp) const override;
  /// Throws InputError only for an invalid option or size of z_guess.
  SolveResult solve(Nlp& nlp, const Eigen::VectorXd& z_guess, const SolverOptions& options) const override;
};

}  // namespace prowl
