#pragma once

#include "alternatives/contact_motion.hpp"
#include "alternatives/formulation.hpp"
#include "alternatives/guess_choice.hpp"
#include "alternatives/inverse_dynamics_check.hpp"
#include "prowl/certificate/certificate.hpp"
#include "prowl/nlp/nlp_solver.hpp"

namespace prowl {

/// What one formulation came to: a line of the table of `prowl compare`.
struct FormulationRun {
  Formulation formulation;
  std::string solver;  ///< name and version: there are several SNOPTs
  int nodes = 0;       ///< of the mesh
  int num_variables = 0, num_constraints = 0;
  int jacobian_nonzeros = 0, hessian_nonzeros = 0;  ///< places of the patterns; of the Hessian the lower triangle
  SolveResult result;
  Trajectory motion;
  Certificate certificate;
  ContactMotion contacts;                 ///< of the motion
  InverseDynamicsCheck inverse_dynamics;  ///< likewise

  double variables_per_node() const { return static_cast<double>(num_variables) / nodes; }
  double constraints_per_node() const { return static_cast<double>(num_constraints) / nodes; }
  double seconds_per_iteration() const { return result.iterations > 0 ? result.seconds / result.iterations : 0.0; }
  /// The check that is furthest beyond its limit, or nearest to it; null without any.
  const CertificateCheck* worst_check() const;
};

/// worst / limit of a check: above 1 it fails. Infinite for NaN, 0 for what is 0 and has to be.
double share_of_limit(const CertificateCheck& check);

/// Solves the problem on its own mesh, from a guess that its task alone gives, and judges the motion. Throws InputError
/// as make_formulation() and make_guess() do, and if the solver cannot take such a program.
FormulationRun run_formulation(const DiscreteProblem& discrete, const Formulation& formulation, const NlpSolver& solver,
                               const SolverOptions& options, HessianKind hessian = HessianKind::exact,
                               const std::string& guess = guess_names().front());
/// The same for a program that somebody else has solved.
FormulationRun judge_formulation(const DiscreteProblem& discrete, const Formulation& formulation, MotionNlp& nlp,
                                 SolveResult result, std::string solver);

}  // namespace prowl
