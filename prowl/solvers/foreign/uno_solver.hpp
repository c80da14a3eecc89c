#pragma once

#include "prowl/nlp/nlp_solver.hpp"

namespace prowl {

/// Uno 2.7 (Vanaret, Leyffer 2024) as filterSQP (Fletcher, Leyffer 2002): sequential quadratic programming with a trust
/// region and a filter, exact Hessian, the quadratic programs by BQPD (Fletcher: active set, dense in the free
/// directions).
///
/// - Of the kind of SNOPT, which it stands in for: few iterations, each of them dear. The time of one grows with the
/// cube
///   of the free directions, and with how far the set of active bounds is from the one it begins with: for meshes of
///   about 10 intervals, not of 100.
/// - `converged` means that Uno has found a point that meets the KKT conditions, and that the point, as the Nlp sees
/// it, is
///   within tolerance.
/// - A value or derivative that cannot be had at a trial point makes the trust region smaller; one that Uno cannot get
/// away
///   from ends the solve as `evaluation_failed`. Limits and interrupts are looked at in every product with the Hessian;
///   a quadratic program that still looks for a feasible point has none, and keeps them waiting.
/// - Stopped early, it returns its best iterate, as IpoptSolver does.
/// - One thread but for evaluations, fixed order of operations: same problem, same start, same machine, same iterates.
/// - BQPD keeps its work in globals: one solve at a time in a process, others wait for it.
class UnoSolver : public NlpSolver {
 public:
  std::string name() const override;
  std::string version() const override;
  std::optional<std::string> why_unsupported(Nlp& nlp) const override;
  /// Throws InputError only if an option or the size of z_start makes no sense.
  SolveResult solve(Nlp& nlp, const Eigen::VectorXd& z_start, const SolverOptions& options) const override;
};

}  // namespace prowl
