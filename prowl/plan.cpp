#include "prowl/plan.hpp"

#include <algorithm>
#include <vector>

#include "prowl/error.hpp"
#include "prowl/feasibility/feasibility.hpp"
#include "prowl/feasibility/rank_check.hpp"
#include "prowl/nlp/constraint_violation.hpp"
#include "prowl/transcription/initial_guess.hpp"
#include "prowl/transcription/mesh.hpp"
#include "prowl/transcription/mesh_levels.hpp"
#include "prowl/transcription/resample.hpp"
#include "prowl/transcription/transcription.hpp"

namespace prowl {

namespace {

using Eigen::VectorXd;

/// What is written of a problem that was not solved: the guess and how far it is off.
SolveResult not_solved(Transcription& nlp, const VectorXd& z) {
  SolveResult result;
  result.status = SolveStatus::infeasible;
  result.message = "not started: there is no solution";
  result.z = z;
  VectorXd rows(nlp.num_constraints());
  nlp.constraints(z, rows);
  result.cost = nlp.cost(z);
  result.constraint_violation = constraint_violation(nlp, z, rows);
  return result;
}

/// The plan if its solve, `before` and the mesh with so many intervals, were interrupted at this iterate.
Plan interrupted_plan(const Plan& plan, const SolveResult& before, int intervals, Transcription& nlp, const VectorXd& z,
                      const SolveProgress& progress) {
  Plan iterate{.trajectory = nlp.unpack(z),
               .solver = plan.solver,
               .hessian = plan.hessian,
               .result = {},
               .levels = plan.levels,
               .certificate = {},
               .num_variables = nlp.num_variables(),
               .num_constraints = nlp.num_constraints(),
               .reasons = {},
               .hints = {}};
  iterate.result.status = SolveStatus::interrupted;
  iterate.result.message = "an iterate on the way";
  iterate.result.cost = progress.cost;
  iterate.result.constraint_violation = progress.constraint_violation;
  iterate.result.dual_violation = progress.dual_violation;
  iterate.result.iterations = before.iterations + progress.iteration;
  iterate.result.seconds = before.seconds + progress.elapsed_seconds;
  iterate.levels.push_back({intervals, SolveStatus::interrupted, progress.iteration, progress.elapsed_seconds, 0.0});
  return iterate;
}

/// The meshes to solve, one after the other.
std::vector<MotionProblem> meshes_of(const MotionProblem& problem, const PlanOptions& options, bool may_have_solution) {
  const bool from_neighbour = !options.start_from.empty() && !options.resume;
  if (!options.coarse_first || from_neighbour || !may_have_solution) return {problem};
  std::vector<MotionProblem> levels = mesh_levels(problem);
  if (options.start_from.empty()) return levels;
  const int intervals = static_cast<int>(options.start_from.nodes.size()) - (options.start_from.nodes.back().phase + 1);
  std::erase_if(levels, [&](const MotionProblem& level) { return count_intervals(level) < intervals; });
  return levels.empty() ? std::vector{problem} : levels;
}

/// Solves the problem on its mesh from plan.trajectory, or from the task alone if that is empty, and adds what comes
/// out to the plan. A problem with reasons against it is not solved.
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
      !plan.trajectory.empty() && (from_elsewhere ? !options.resume : plan.result.status == SolveStatus::converged);
  level_options.start_multipliers = from_elsewhere ? options.start_multipliers : std::vector<StageMultipliers>{};
  constexpr double kShortestSeconds = 1e-3;  // when the time is up, a further level only says so
  level_options.max_seconds = std::max(options.solver.max_seconds - plan.result.seconds, kShortestSeconds);
  if (options.on_level) options.on_level(count_intervals(problem));

  const SolveResult before = std::move(plan.result);
  SolveProgress progress;
  if (options.on_iterate) {
    level_options.on_iteration = [&](const SolveProgress& now) {
      progress = now;
      if (options.solver.on_iteration) options.solver.on_iteration(now);
    };
    level_options.on_iterate = [&](const VectorXd& z) {
      try {
        options.on_iterate(problem, interrupted_plan(plan, before, count_intervals(problem), nlp, z, progress));
      } catch (const NumericalError&) {  // no motion, and the solver will find out
      }
    };
  }
  const VectorXd start = nlp.pack(guess);
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

/// By someone who will not wait, whatever mesh is next.
bool is_stopped(SolveStatus status) { return status == SolveStatus::interrupted || status == SolveStatus::time_limit; }

}  // namespace

bool is_worth_going_on_from(SolveStatus status) {
  return status != SolveStatus::infeasible && status != SolveStatus::evaluation_failed &&
         status != SolveStatus::solver_failed;
}

MotionProblem mesh_of(const MotionProblem& problem, const Plan& plan) {
  if (plan.levels.empty() || plan.levels.back().intervals == count_intervals(problem)) return problem;
  for (MotionProblem& level : mesh_levels(problem)) {
    if (count_intervals(level) == plan.levels.back().intervals) return std::move(level);
  }
  return problem;
}

Plan make_plan(const MotionProblem& problem, const NlpSolver& solver, const PlanOptions& options) {
  validate(problem);
  Plan plan;
  plan.solver = solver.name();
  plan.hessian = options.hessian;
  plan.reasons = proofs_of_infeasibility(problem);
  plan.trajectory = options.start_from;
  const std::vector<MotionProblem> meshes = meshes_of(problem, options, plan.reasons.empty());
  const MotionProblem* solved = &meshes.front();  // there is one, if only for its guess
  for (const MotionProblem& mesh : meshes) {
    if (&mesh != &meshes.front() && !is_worth_going_on_from(plan.result.status)) plan.trajectory = {};
    solve_level(mesh, solver, options, plan);
    solved = &mesh;
    if (is_stopped(plan.result.status))
      break;  // what a finer mesh makes of it in no time is further off, and worse to resume
  }
  plan.certificate = certify(*solved, plan.trajectory);
  const bool ended_by_itself =
      plan.result.status != SolveStatus::interrupted;  // who stops it knows why, and will not wait
  if (plan.reasons.empty() && !plan.certificate.passed && ended_by_itself) {
    const Trajectory guess = initial_guess(problem, make_mesh(problem));
    plan.hints = plan.result.status == SolveStatus::converged
                     ? postures_that_lose_rank(problem, guess)
                     : doubts(problem, guess, options.hint_solver ? *options.hint_solver : solver);
  }
  return plan;
}

}  // namespace prowl
