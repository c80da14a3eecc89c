#include "prowl/plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "prowl/elastic/elastic_solve.hpp"
#include "prowl/error.hpp"
#include "prowl/feasibility/feasibility.hpp"
#include "prowl/feasibility/rank_check.hpp"
#include "prowl/guess/initial_guess.hpp"
#include "prowl/mesh/mesh_levels.hpp"
#include "prowl/mesh/resample.hpp"
#include "prowl/nlp/constraint_violation.hpp"
#include "prowl/nlp/stopwatch.hpp"
#include "prowl/repeat.hpp"
#include "prowl/transcription/transcription.hpp"

namespace prowl {

namespace {

using Eigen::VectorXd;

constexpr double kRestorationPart = 0.5;  ///< of the remaining time; the other is for the solve from its motion

/// For the next solve [s], never zero: when the time is up, it ends at once.
double seconds_left(const PlanOptions& options, const Plan& plan) {
  constexpr double kLeast = 1e-3;
  return std::max(options.solver.max_seconds - plan.result.seconds, kLeast);
}

/// The problem on the meshes to solve before its own, the coarsest first.
std::vector<DiscreteProblem> coarser_problems(const DiscreteProblem& asked, const PlanOptions& options,
                                              bool may_have_solution) {
  const bool from_neighbour = !options.warm_start.empty() && !options.resume;
  if (!options.coarse_first || from_neighbour || !may_have_solution) return {};
  std::vector<DiscreteProblem> problems;
  const std::vector<Mesh> meshes = mesh_levels(asked.problem, asked.mesh);
  for (std::size_t i = 0; i + 1 < meshes.size(); ++i) {
    const bool is_behind = meshes[i].num_nodes() < static_cast<int>(options.warm_start.nodes.size());
    if (!is_behind) problems.emplace_back(asked.problem, meshes[i]);
  }
  return problems;
}

Trajectory timed_guess(const DiscreteProblem& problem, SolveTimes& times) {
  const Stopwatch stopwatch(times.guess);
  return initial_guess(problem);
}

/// Result for a problem that is not solved: the guess with its violation.
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

/// The plan if its solve on this mesh were interrupted at this iterate, with time and iterations of the meshes before.
Plan interrupted_plan(const Plan& plan, const SolveResult& before, const Mesh& mesh, Transcription& nlp,
                      const VectorXd& z, const SolveProgress& progress) {
  Plan iterate{.trajectory = nlp.unpack(z),
               .mesh = mesh,
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
  iterate.result.message = "an iterate of an unfinished solve";
  iterate.result.cost = progress.cost;
  iterate.result.constraint_violation = progress.constraint_violation;
  iterate.result.dual_violation = progress.dual_violation;
  iterate.result.iterations = before.iterations + progress.iteration;
  iterate.result.seconds = before.seconds + progress.elapsed_seconds;
  iterate.levels.push_back(
      {mesh.num_intervals(), SolveStatus::interrupted, progress.iteration, progress.elapsed_seconds, 0.0});
  return iterate;
}

/// Options of the solver on this level: quality of the start, multipliers, remaining time.
SolverOptions options_of_level(const PlanOptions& options, const Plan& plan, bool is_cold_start) {
  SolverOptions of_level = options.solver;
  const bool from_elsewhere = plan.levels.empty();  // --warm-start
  of_level.is_warm_start =
      !is_cold_start && (from_elsewhere ? !options.resume : plan.result.status == SolveStatus::converged);
  of_level.warm_start_multipliers = from_elsewhere ? options.warm_start_multipliers : std::vector<StageMultipliers>{};
  of_level.max_seconds = seconds_left(options, plan);
  return of_level;
}

/// Solves the program from the guess and adds the result to the plan; with reasons against it, does not solve.
void solve(Transcription& nlp, const Trajectory& guess, const Mesh& mesh, const NlpSolver& solver,
           const PlanOptions& options, SolverOptions of_level, Plan& plan) {
  if (options.on_level) options.on_level(mesh.num_intervals());
  const SolveResult before = std::move(plan.result);
  SolveProgress progress;
  if (options.on_iterate) {
    of_level.on_iteration = [&](const SolveProgress& now) {
      progress = now;
      if (options.solver.on_iteration) options.solver.on_iteration(now);
    };
    of_level.on_iterate = [&](const VectorXd& z) {
      try {
        options.on_iterate(interrupted_plan(plan, before, mesh, nlp, z, progress));
      } catch (const NumericalError&) {  // no motion; the solver reports it
      }
    };
  }
  const VectorXd z_guess = nlp.pack(guess);
  plan.result = plan.reasons.empty() ? solver.solve(nlp, z_guess, of_level) : not_solved(nlp, z_guess);
  plan.mesh = mesh;
  plan.levels.push_back(
      {mesh.num_intervals(), plan.result.status, plan.result.iterations, plan.result.seconds, plan.result.times.cpu});
  plan.result.iterations += before.iterations;
  plan.result.seconds += before.seconds;
  plan.result.times += before.times;
  plan.trajectory = nlp.unpack(plan.result.z);
  plan.num_variables = nlp.num_variables();
  plan.num_constraints = nlp.num_constraints();
}

/// Computes Plan::hints.
std::vector<std::string> hints(const DiscreteProblem& asked, const Plan& plan, const NlpSolver& solver,
                               const PlanOptions& options) {
  if (!plan.reasons.empty() || plan.certificate.passed || plan.result.status == SolveStatus::interrupted) return {};
  const Trajectory guess = initial_guess(asked);
  const NlpSolver* const elastic_solver = options.elastic_solver ? options.elastic_solver() : nullptr;
  return plan.result.status == SolveStatus::converged ? postures_that_lose_rank(asked.problem, guess)
                                                      : doubts(asked, guess, elastic_solver ? *elastic_solver : solver);
}

/// The plan from a motion of restore(), with the time and iterations of the failed solve before it.
Plan solved_again(const DiscreteProblem& asked, const NlpSolver& solver, PlanOptions options, const Plan& failed,
                  const Trajectory& motion) {
  options.warm_start = motion;
  options.warm_start_multipliers.clear();
  options.resume = true;
  options.coarse_first = false;
  options.solver.max_seconds = seconds_left(options, failed);
  Plan plan = solve_plan(asked, solver, options);
  if (has_failed(plan.result.status)) plan.hints = failed.hints;
  plan.levels.insert(plan.levels.begin(), failed.levels.begin(), failed.levels.end());
  plan.result.iterations += failed.result.iterations;
  plan.result.seconds += failed.result.seconds;
  plan.result.times += failed.result.times;
  return plan;
}

/// solve_plan(), and again from a restored motion if there is one.
Plan solve_or_restore(const DiscreteProblem& asked, const NlpSolver& solver, const PlanOptions& options) {
  Plan plan = solve_plan(asked, solver, options);
  const std::optional<Trajectory> motion = restore(asked, options, plan);
  return motion ? solved_again(asked, solver, options, plan, *motion) : plan;
}

}  // namespace

bool is_stopped(SolveStatus status) { return status == SolveStatus::interrupted || status == SolveStatus::time_limit; }

bool has_failed(SolveStatus status) { return status != SolveStatus::converged && !is_stopped(status); }

bool is_worth_going_on_from(SolveStatus status) {
  return status != SolveStatus::infeasible && status != SolveStatus::evaluation_failed &&
         status != SolveStatus::solver_failed;
}

Plan solve_plan(const DiscreteProblem& asked, const NlpSolver& solver, const PlanOptions& options) {
  Plan plan;
  plan.trajectory = options.warm_start;
  plan.solver = solver.name();
  plan.hessian = options.hessian;
  plan.reasons = proofs_of_infeasibility(asked.problem, asked.schedule);

  const std::vector<DiscreteProblem> coarser = coarser_problems(asked, options, plan.reasons.empty());
  const DiscreteProblem* problem = nullptr;
  std::size_t level = 0;
  do {
    problem = level < coarser.size() ? &coarser[level] : &asked;
    const bool from_task = plan.trajectory.empty() || (level > 0 && !is_worth_going_on_from(plan.result.status));
    const Trajectory guess = from_task ? timed_guess(*problem, plan.result.times) : resample(plan.trajectory, *problem);
    const bool is_corrected = options.corrected && !from_task;
    Transcription nlp(*problem, guess, is_corrected ? deferred_corrections(*problem, guess) : Corrections{});
    nlp.use_hessian(options.hessian);
    if (const auto reason = solver.why_unsupported(nlp)) throw InputError(*reason);
    solve(nlp, guess, problem->mesh, solver, options, options_of_level(options, plan, from_task), plan);
  } while (level++ < coarser.size() && !is_stopped(plan.result.status));
  return plan;
}

std::optional<Trajectory> restore(const DiscreteProblem& asked, const PlanOptions& options, Plan& plan) {
  const bool is_at_limit = plan.result.status == SolveStatus::iteration_limit;  // which ends it, as those of time do
  if (!has_failed(plan.result.status) || is_at_limit || !plan.reasons.empty()) return std::nullopt;
  const NlpSolver* const solver = options.elastic_solver ? options.elastic_solver() : nullptr;
  if (!solver) return std::nullopt;
  SolverOptions with;
  with.threads = options.solver.threads;
  with.interrupt = options.solver.interrupt;
  with.max_seconds = kRestorationPart * seconds_left(options, plan);
  ElasticResult found;
  {
    const Stopwatch stopwatch(plan.result.seconds);
    found = elastic_solve(asked, *solver, with);
  }
  if (found.status == SolveStatus::interrupted) {
    plan.result.status = SolveStatus::interrupted;
    plan.result.message = "stopped on request";
  }
  if (found.status != SolveStatus::converged) return std::nullopt;
  const int intervals = asked.mesh.num_intervals();
  if (found.breaches.empty()) {
    plan.hints.push_back(
        fmt::format("no limit has to give way on {} mesh intervals: the solver missed a motion", intervals));
    return std::move(found.motion);
  }
  plan.result.status = SolveStatus::infeasible;
  plan.result.message = fmt::format("no motion nearby keeps all limits on {} mesh intervals", intervals);
  constexpr std::size_t kMost = 6;
  for (std::size_t i = 0; i < std::min(found.breaches.size(), kMost); ++i)
    plan.hints.push_back("has to give way: " + in_words(found.breaches[i], asked.problem));
  return std::nullopt;
}

void judge(const DiscreteProblem& asked, const NlpSolver& solver, const PlanOptions& options, Plan& plan) {
  plan.certificate = plan.mesh == asked.mesh ? certify(asked, plan.trajectory)
                                             : certify(DiscreteProblem(asked.problem, plan.mesh), plan.trajectory);
  std::ranges::move(hints(asked, plan, solver, options), std::back_inserter(plan.hints));
}

Plan make_plan(const DiscreteProblem& asked, const NlpSolver& solver, const PlanOptions& options) {
  if (has_repetitions(asked.problem)) {
    Plan plan = solve_or_restore(first_cycle(asked), solver, options_of_cycle(asked, options));
    repeat(asked, solver, options, plan);
    return plan;
  }
  Plan plan = solve_or_restore(asked, solver, options);
  judge(asked, solver, options, plan);
  return plan;
}

}  // namespace prowl
