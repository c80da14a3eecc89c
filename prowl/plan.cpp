#include "prowl/plan.hpp"

#include <algorithm>

#include "prowl/error.hpp"
#include "prowl/transcription/initial_guess.hpp"
#include "prowl/transcription/mesh.hpp"
#include "prowl/transcription/mesh_levels.hpp"
#include "prowl/transcription/resample.hpp"
#include "prowl/transcription/transcription.hpp"

namespace prowl {

namespace {

/// Whether the next level may start from where this one stopped; after a failure it starts from the task again.
bool is_worth_going_on_from(SolveStatus status) {
  return status != SolveStatus::infeasible && status != SolveStatus::evaluation_failed &&
         status != SolveStatus::solver_failed;
}

void solve_level(const MotionProblem& problem, const NlpSolver& solver, const PlanOptions& options, Plan& plan) {
  const Mesh mesh = make_mesh(problem);
  const Trajectory guess =
      plan.trajectory.empty() ? initial_guess(problem, mesh) : resample(plan.trajectory, problem, mesh);
  Transcription nlp{problem, mesh, guess};
  if (const auto reason = solver.why_unsupported(nlp)) throw InputError(*reason);

  SolverOptions level_options = options.solver;
  level_options.start_is_near = !plan.levels.empty() && !plan.trajectory.empty();
  constexpr double kShortestSeconds = 1e-3;  // when the time is up, a further level only says so
  level_options.max_seconds = std::max(options.solver.max_seconds - plan.result.seconds, kShortestSeconds);
  if (options.on_level) options.on_level(count_intervals(problem));

  const SolveResult before = std::move(plan.result);
  plan.result = solver.solve(nlp, nlp.pack(guess), level_options);
  plan.levels.push_back({count_intervals(problem), plan.result.status, plan.result.iterations, plan.result.seconds});
  plan.result.iterations += before.iterations;
  plan.result.seconds += before.seconds;
  plan.result.evaluation_seconds += before.evaluation_seconds;
  plan.trajectory = nlp.unpack(plan.result.z);
  plan.num_variables = nlp.num_variables();
  plan.num_constraints = nlp.num_constraints();
}

}  // namespace

Plan make_plan(const MotionProblem& problem, const NlpSolver& solver, const PlanOptions& options) {
  validate(problem);
  Plan plan;
  plan.trajectory = options.start_from;
  for (const MotionProblem& level : plan.trajectory.empty() ? mesh_levels(problem) : std::vector{problem}) {
    if (!plan.levels.empty() && !is_worth_going_on_from(plan.result.status)) plan.trajectory = {};
    solve_level(level, solver, options, plan);
  }
  plan.certificate = certify(problem, plan.trajectory);
  return plan;
}

}  // namespace prowl
