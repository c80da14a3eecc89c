#include "prowl/plan.hpp"

#include "prowl/error.hpp"
#include "prowl/transcription/initial_guess.hpp"
#include "prowl/transcription/mesh.hpp"
#include "prowl/transcription/transcription.hpp"

namespace prowl {

Plan make_plan(const MotionProblem& problem, const NlpSolver& solver, const SolverOptions& options) {
  validate(problem);
  const Mesh mesh = make_mesh(problem);
  const Trajectory guess = initial_guess(problem, mesh);
  Transcription nlp{problem, mesh, guess};
  if (const auto reason = solver.why_unsupported(nlp)) throw InputError(*reason);

  Plan plan;
  plan.num_variables = nlp.num_variables();
  plan.num_constraints = nlp.num_constraints();
  plan.result = solver.solve(nlp, nlp.pack(guess), options);
  plan.trajectory = nlp.unpack(plan.result.z);
  plan.certificate = certify(problem, plan.trajectory);
  return plan;
}

}  // namespace prowl
