#pragma once

#include "alternatives/contact_motion.hpp"
#include "alternatives/formulation.hpp"
#include "alternatives/guess_choice.hpp"
#include "alternatives/inverse_dynamics_check.hpp"
#include "prowl/certificate/certificate.hpp"
#include "prowl/nlp/nlp_solver.hpp"

namespace prowl {

/// Result of one formulation: a line of the table of `prowl compare`.
struct FormulationRun {
  Formulation formulation;
  std::string solver;  ///< name and version: there are several SNOPTs
  int nodes = 0;       ///< of the mesh
  int num_variables = 0, num_constraints = 0;
  int jacobian_nonzeros = 0, hessian_nonzeros = 0;  ///< entries of the patterns; Hessian: lower triangle
  SolveResult result;
  Trajectory motion;
  Certificate certificate;
  ContactMotion contacts;                 ///< of the motion
  InverseDynamicsCheck inverse_dynamics;  ///< likewise

  double variables_per_node() const { return static_cast<double>(num_variables) / nodes; }
  double constraints_per_node() const { return static_cast<double>(num_constraints) / nodes; }
  double seconds_per_iteration() const { return result.iterations > 0 ? result.seconds / result.iterations : 0.0; }
  /// The check with the largest share_of_limit(); null without checks.
  const CertificateCheck* worst_check() const;
};

/// worst / limit of a check; it fails above 1. Infinite for NaN; 0 if worst is 0, as for zero
/// limits.
double share_of_limit(const CertificateCheck& check);

/// Solves the problem on its mesh from an initial guess, and certifies the motion. Throws
/// InputError like make_formulation() and make_guess(), or if the solver does not support the
/// program.
FormulationRun run_formulation(const DiscreteProblem& discrete, const Formulation& formulation, const NlpSolver& solver,
                               const SolverOptions& options, HessianKind hessian = HessianKind::exact,
                               const std::string& guess = guess_names().front());
/// The same for a program solved elsewhere.
FormulationRun measure_formulation(const DiscreteProblem& discrete, const Formulation& formulation, MotionNlp& nlp,
                                   SolveResult result, std::string solver);

}  // namespace prowl
