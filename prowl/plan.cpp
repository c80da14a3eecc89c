#include "prowl/plan.hpp"

#include "prowl/error.hpp"
#include "prowl/feasibility/feasibility.hpp"
#include "prowl/nlp/constraint_violation.hpp"
#include "prowl/transcription/initial_guess.hpp"
#include "prowl/transcription/mesh.hpp"
#include "prowl/transcription/transcription.hpp"

namespace prowl {

namespace {

SolveResult not_solved(Transcription& nlp, const Eigen::VectorXd& z) {
  SolveResult result{.status = SolveStatus::infeasible, .message = "not started: there is no solution", .z = z};
  Eigen::VectorXd rows(nlp.num_constraints());
  nlp.constraints(z, rows);
  result.cost = nlp.cost(z);
  result.constraint_violation = constraint_violation(nlp, z, rows);
  return result;
}

}  // namespace

Plan make_plan(const MotionProblem& problem, const NlpSolver& solver, const SolverOptions& options) {
  validate(problem);
  const Mesh mesh = make_mesh(problem);
  const Trajectory guess = initial_guess(problem, mesh);
  Transcription nlp{problem, mesh, guess};
  if (const auto reason = solver.why_unsupported(nlp)) throw InputError(*reason);

  Plan plan;
  plan.num_variables = nlp.num_variables();
  plan.num_constraints = nlp.num_constraints();
  plan.reasons = proofs_of_infeasibility(problem);
  plan.result = plan.reasons.empty() ? solver.solve(nlp, nlp.pack(guess), options) : not_solved(nlp, nlp.pack(guess));
  if (plan.reasons.empty() && plan.result.status != SolveStatus::converged) plan.hints = doubts(problem, guess, solver);
  plan.trajectory = nlp.unpack(plan.result.z);
  plan.certificate = certify(problem, plan.trajectory);
  return plan;
}

}  // namespace prowl
