#pragma once

#include "prowl/nlp/nlp_solver.hpp"

namespace prowl {

/// Linear solver in Ipopt: MUMPS, or SPRAL's SSIDS (Hogg, Ovtchinnikov, Scott 2016).
enum class IpoptLinearSolver { mumps, spral };

/// Ipopt 3.14 (Wächter, Biegler 2006: primal-dual interior point, filter line search) with the exact Hessian.
///
/// - Only Ipopt's "Solve_Succeeded" is `converged`. Its "acceptable level" allows violations of 1e-2
///   and is switched off.
/// - A failed evaluation at a trial point shortens the step. A failure that Ipopt cannot avoid ends
///   the solve as `evaluation_failed`, with the constraint or variable in the message.
/// - Stopped early, it returns its best iterate: smallest violation, and smallest cost among those
///   within tolerance.
/// - Deterministic on one machine: fixed elimination ordering, one BLAS thread. With SPRAL this holds
///   for builds without OpenMP, as in the casadi wheel; builds with OpenMP were not tested.
class IpoptSolver : public NlpSolver {
 public:
  explicit IpoptSolver(IpoptLinearSolver linear_solver = IpoptLinearSolver::mumps) : linear_solver_(linear_solver) {}

  std::string name() const override;
  std::string version() const override;  ///< of the loaded library
  std::optional<std::string> why_unsupported(Nlp& nlp) const override;
  /// Throws InputError only for an invalid option or size of z_guess.
  SolveResult solve(Nlp& nlp, const Eigen::VectorXd& z_guess, const SolverOptions& options) const override;

  /// Why Prowl cannot use the loaded libipopt.so, for the user; nullopt if it can.
  static std::optional<std::string> why_wrong_library();

 private:
  IpoptLinearSolver linear_solver_;
};

}  // namespace prowl
