#pragma once

#include "prowl/nlp/nlp_solver.hpp"

namespace prowl {

/// Fatrop 1.1 (Vanroye, Sathya, De Schutter, Decré 2023: a primal-dual interior point method with filter line search as
/// Ipopt's, whose linear systems are solved stage by stage by a Riccati recursion) with the exact Hessian. Its time is
/// linear in the number of stages, with no ordering and no pivoting across them.
///
/// - Takes problems with a stage-wise form only (Nlp::stagewise).
/// - `converged` means that Fatrop says so and that the point, as the Nlp sees it, is within tolerance.
/// - A value that is not finite at a trial point shortens the step; a derivative that is not ends the solve as
///   `evaluation_failed`. Limits and interrupts are looked at once an iteration, time at every trial point too.
/// - Stopped early, it returns its best iterate, as IpoptSolver does. Multipliers are not given.
/// - One thread, fixed order of operations: same problem, same start, same machine, same iterates.
class FatropSolver : public NlpSolver {
 public:
  std::string name() const override;
  std::string version() const override;
  std::optional<std::string> why_unsupported(Nlp& nlp) const override;
  /// Throws InputError only if an option or the size of z_start makes no sense.
  SolveResult solve(Nlp& nlp, const Eigen::VectorXd& z_start, const SolverOptions& options) const override;

  /// What the kernels of its linear algebra (BLASFEO) were built for: "AVX2 FMA"; "" if they know of no instruction
  /// set.
  static std::string linear_algebra();
  /// What of that this processor has, in the same words.
  static std::string processor();
};

}  // namespace prowl
