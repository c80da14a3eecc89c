#pragma once

#include "prowl/nlp/nlp_solver.hpp"

namespace prowl {

/// Who solves Ipopt's linear systems: MUMPS, or SPRAL's SSIDS (Hogg, Ovtchinnikov, Scott 2016).
enum class IpoptLinearSolver { mumps, spral };

/// Ipopt 3.14 (Wächter, Biegler 2006: primal-dual interior point, filter line search) with the exact Hessian.
///
/// - Only Ipopt's "Solve_Succeeded" is `converged`; its "acceptable level" allows violations of 1e-2 and is switched
/// off.
/// - An evaluation that fails at a trial point shortens the step; one that Ipopt cannot step away from ends the solve
/// as
///   `evaluation_failed`, with constraint or variable in the message.
/// - Stopped early, it returns its best iterate: of least violation, and of least cost among those within tolerance.
/// - Same problem, same start, same machine: same iterates (fixed elimination ordering, one thread in BLAS). With SPRAL
/// that
///   is so for a build without OpenMP, as in the casadi wheel; one with OpenMP was not tried.
class IpoptSolver : public NlpSolver {
 public:
  explicit IpoptSolver(IpoptLinearSolver linear_solver = IpoptLinearSolver::mumps) : linear_solver_(linear_solver) {}

  std::string name() const override;
  std::string version() const override;  ///< of the library that is loaded
  std::optional<std::string> why_unsupported(Nlp& nlp) const override;
  /// Throws InputError only if an option or the size of z_start makes no sense.
  SolveResult solve(Nlp& nlp, const Eigen::VectorXd& z_start, const SolverOptions& options) const override;

  /// The reason, for the user to read, why Prowl cannot work with the libipopt.so that is loaded.
  static std::optional<std::string> why_wrong_library();

 private:
  IpoptLinearSolver linear_solver_;
};

}  // namespace prowl
