#include "prowl/solvers/riccati_solver.hpp"

#include <fmt/format.h>

#include <chrono>

#include "prowl/error.hpp"
#include "prowl/solvers/interior_point.hpp"
#include "prowl/solvers/judge.hpp"
#include "prowl/solvers/stopwatch.hpp"

namespace prowl {

namespace {

using Eigen::VectorXd;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

}  // namespace

std::string RiccatiSolver::name() const { return "Riccati"; }

std::string RiccatiSolver::version() const { return "1"; }

std::optional<std::string> RiccatiSolver::why_unsupported(Nlp& nlp) const {
  const StagewiseNlp* stages = nlp.stagewise();
  if (!stages) return "the Riccati solver needs a problem that is a chain of stages, and this one is not";
  for (int k = 0; k < stages->num_stages(); ++k) {
    for (int i = 0; i < stages->size(k).inequalities; ++i) {
      if (stages->lower(k)(i) < stages->upper(k)(i)) continue;  // false for NaN too
      return fmt::format("{}: bounds [{}, {}] leave nothing", stages->describe_stage(k), stages->lower(k)(i),
                         stages->upper(k)(i));
    }
  }
  return std::nullopt;
}

SolveResult RiccatiSolver::solve(Nlp& nlp, const VectorXd& z_start, const SolverOptions& options) const {
  validate(options);
  if (z_start.size() != nlp.num_variables()) {
    throw InputError(fmt::format("start has {} variables, the problem has {}", z_start.size(), nlp.num_variables()));
  }
  const Clock::time_point began = Clock::now();
  const double cpu_start = cpu_seconds();
  SolveResult result;
  result.z = z_start;
  if (const auto reason = why_unsupported(nlp)) {
    result.message = *reason;
    return result;
  }
  StagewiseNlp& stages = *nlp.stagewise();
  InteriorPoint method(stages, options);
  IterateFigures best;
  StageVectors best_stages;
  const auto watch = [&](int iteration, const IterateFigures& figures) -> std::optional<InteriorPoint::Ending> {
    using enum SolveStatus;
    if (is_better(figures, best, options.tolerance)) {
      best = figures;
      best_stages = method.stages();
    }
    if (options.on_iteration) {
      options.on_iteration({iteration, figures.cost, figures.violation, figures.dual_violation, seconds_since(began)});
    }
    if (options.interrupt && options.interrupt->load()) return {{interrupted, "stopped on request"}};
    if (seconds_since(began) > options.max_seconds) return {{time_limit, "time limit reached"}};
    if (iteration >= options.max_iterations) return {{iteration_limit, "iteration limit reached"}};
    return std::nullopt;
  };
  const InteriorPoint::Ending ending = method.run(stages.stages(z_start), watch);
  result.status = ending.status;
  result.message = ending.message;
  result.iterations = method.iterations();
  const bool has_converged = result.status == SolveStatus::converged;
  if (has_converged || !best_stages.empty()) {
    result.z = stages.flat(has_converged ? method.stages() : best_stages);
    if (has_converged) result.stage_multipliers = method.multipliers();
    result.dual_violation = (has_converged ? method.figures() : best).dual_violation;
  }

  judge(nlp, options.tolerance, name(), result);
  result.times = method.times();
  result.times.cpu = cpu_seconds() - cpu_start;
  result.seconds = seconds_since(began);
  return result;
}

}  // namespace prowl
