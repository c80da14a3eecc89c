#include "alternatives/run_formulation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "prowl/error.hpp"

namespace prowl {

double share_of_limit(const CertificateCheck& check) {
  if (std::isnan(check.worst)) return std::numeric_limits<double>::infinity();
  return check.worst == 0.0 ? 0.0 : check.worst / check.limit;  // some limits are 0
}

const CertificateCheck* FormulationRun::worst_check() const {
  const auto worst = std::ranges::max_element(certificate.checks, {}, share_of_limit);
  return worst == certificate.checks.end() ? nullptr : &*worst;
}

FormulationRun measure_formulation(const DiscreteProblem& discrete, const Formulation& formulation, MotionNlp& nlp,
                                   SolveResult result, std::string solver) {
  FormulationRun run{.formulation = formulation,
                     .solver = std::move(solver),
                     .nodes = discrete.num_nodes(),
                     .num_variables = nlp.num_variables(),
                     .num_constraints = nlp.num_constraints(),
                     .jacobian_nonzeros = nlp.jacobian_pattern().size(),
                     .hessian_nonzeros = nlp.hessian_pattern().size(),
                     .result = std::move(result),
                     .motion = {},
                     .certificate = {},
                     .contacts = {},
                     .inverse_dynamics = {}};
  run.motion = nlp.unpack(run.result.z);
  run.certificate = certify(discrete, run.motion);
  run.contacts = contact_motion(discrete.problem, run.motion);
  run.inverse_dynamics = check_by_inverse_dynamics(discrete.problem, run.motion);
  return run;
}

FormulationRun run_formulation(const DiscreteProblem& discrete, const Formulation& formulation, const NlpSolver& solver,
                               const SolverOptions& options, HessianKind hessian, const std::string& guess_name) {
  const Trajectory guess = make_guess(guess_name, discrete);
  const std::unique_ptr<MotionNlp> nlp = make_formulation(formulation, discrete, guess);
  nlp->use_hessian(hessian);
  if (const auto reason = solver.why_unsupported(*nlp)) throw InputError(*reason);
  return measure_formulation(discrete, formulation, *nlp, solver.solve(*nlp, nlp->pack(guess), options),
                             solver.name() + " " + solver.version());
}

}  // namespace prowl
