#include "prowl/plan.hpp"

#include <algorithm>

#include "prowl/error.hpp"
#include "prowl/feasibility/feasibility.hpp"
#include "prowl/nlp/constraint_violation.hpp"
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

/// What is written of a problem that was not solved: the guess and how far it is off.
SolveResult not_solved(Transcription& nlp, const Eigen::VectorXd& z) {
  SolveResult result{.status = SolveStatus::infeasible, .message = "not started: there is no solution", .z = z};
  Eigen::VectorXd rows(nlp.num_constraints());
  nlp.constraints(z, rows);
  result.cost = nlp.cost(z);
  result.constraint_violation = constraint_violation(nlp, z, rows);
  return result;
}

/// Solves the problem on its mesh from plan.trajectory, or from the task alone if that is empty, and adds what comes out to
/// the plan. A problem with reasons against it is not solved.
void solve_level(const MotionProblem& problem, const NlpSolver& solver, const PlanOptions& options, Plan& plan) {
  const Mesh mesh = make_mesh(problem);
  const Trajectory guess =
      plan.trajectory.empty() ? initial_guess(problem, mesh) : resample(plan.trajectory, problem, mesh);
  Transcription nlp{problem, mesh, guess};
  nlp.use_hessian(options.hessian);
  if (const auto reason = solver.why_unsupported(nlp)) throw InputError(*reason);

  SolverOptions level_options = options.solver;
  const bool from_elsewhere = plan.levels.empty();  // --warm-start
  level_options.start_is_near =
      !plan.trajectory.empty() && (from_elsewhere || plan.result.status == SolveStatus::converged);
  level_options.start_multipliers = from_elsewhere ? options.start_multipliers : std::vector<StageMultipliers>{};
  constexpr double kShortestSeconds = 1e-3;  // when the time is up, a further level only says so
  level_options.max_seconds = std::max(options.solver.max_seconds - plan.result.seconds, kShortestSeconds);
  if (options.on_motion) level_options.on_iterate = [&](const Eigen::VectorXd& z) { options.on_motion(nlp.unpack(z)); };
  if (options.on_level) options.on_level(count_intervals(problem));

  const SolveResult before = std::move(plan.result);
  const Eigen::VectorXd start = nlp.pack(guess);
  plan.result = plan.reasons.empty() ? solver.solve(nlp, start, level_options) : not_solved(nlp, start);
  plan.levels.push_back({count_intervals(problem), plan.result.status, plan.result.iterations, plan.result.seconds,
                         plan.result.times.cpu});
  plan.result.iterations += before.iterations;
  plan.result.seconds += before.seconds;
  plan.result.times += before.times;
  plan.trajectory = nlp.unpack(plan.result.z);
  plan.num_variables = nlp.num_variables();
  plan.num_constraints = nlp.num_constraints();
}

}  // namespace

Plan make_plan(const MotionProblem& problem, const NlpSolver& solver, const PlanOptions& options) {
  validate(problem);
  Plan plan;
  plan.solver = solver.name();
  plan.hessian = options.hessian;
  plan.reasons = proofs_of_infeasibility(problem);
  plan.trajectory = options.start_from;
  const bool one_level = !options.coarse_first || !plan.trajectory.empty() || !plan.reasons.empty();
  for (const MotionProblem& level : one_level ? std::vector{problem} : mesh_levels(problem)) {
    if (!plan.levels.empty() && !is_worth_going_on_from(plan.result.status)) plan.trajectory = {};
    solve_level(level, solver, options, plan);
  }
  const bool ended_by_itself = plan.result.status != SolveStatus::interrupted;  // who stops it knows why, and will not wait
  if (plan.reasons.empty() && plan.result.status != SolveStatus::converged && ended_by_itself) {
    plan.hints = doubts(problem, initial_guess(problem, make_mesh(problem)),
                        options.hint_solver ? *options.hint_solver : solver);
  }
  plan.certificate = certify(problem, plan.trajectory);
  return plan;
}

}  // namespace prowl
