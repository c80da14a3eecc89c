#pragma once

#include "prowl/nlp/nlp_solver.hpp"

namespace prowl {

/// Fatrop 1.1 (Vanroye, Sathya, De Schutter, Decré 2023: a primal-dual interior point method with
/// filter line search as Ipopt's, whose linear systems are solved stage by stage by a Riccati
/// recursion) with the exact Hessian. Time is linear in the number of stages; no ordering or
/// pivoting across stages.
///
/// - Solves only problems with a stage-wise form (Nlp::stagewise).
/// - `converged`: Fatrop reports convergence, and the point is within tolerance in the Nlp.
/// - A non-finite value at a trial point shortens the step; a non-finite derivative ends the solve
///   as `evaluation_failed`. Limits and interrupts are checked once per iteration, time at every
///   trial point, too.
/// - Stopped early, it returns its best iterate, like IpoptSolver. It returns no multipliers.
/// - One thread, fixed order of operations: deterministic on one machine.
class FatropSolver : public NlpSolver {
 public:
  std::string name() const override;
  std::string version() const override;
  std::optional<std::string> why_unsupported(Nlp& nlp) const override;
  /// Throws InputError only for an invalid option or size of z_guess.
  SolveResult solve(Nlp& nlp, const Eigen::VectorXd& z_guess, const SolverOptions& options) const override;

  /// Instruction sets that BLASFEO was built for: "AVX2 FMA"; "" if generic.
  static std::string linear_algebra();
  /// Instruction sets that this processor supports, in the same words.
  static std::string processor();
};

}  // namespace prowl
