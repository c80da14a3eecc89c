#include "prowl/solvers/riccati/riccati_solver.hpp"

#include <optional>

#include "prowl/nlp/constraint_violation.hpp"
#include "prowl/nlp/stopwatch.hpp"
#include "prowl/solvers/arguments.hpp"
#include "prowl/solvers/remeasure_result.hpp"
#include "prowl/solvers/riccati/interior_point.hpp"
#include "prowl/solvers/thrown_error.hpp"

namespace prowl {

using Eigen::VectorXd;

std::string RiccatiSolver::name() const { return "Riccati"; }

std::string RiccatiSolver::version() const { return "1"; }

std::optional<std::string> RiccatiSolver::why_unsupported(Nlp& nlp) const {
  return why_no_chain(nlp, "the Riccati solver");
}

SolveResult RiccatiSolver::solve(Nlp& nlp, const VectorXd& z_guess, const SolverOptions& options) const {
  check_arguments(nlp, z_guess, options);
  const double began = wall_seconds();
  const double cpu_began = cpu_seconds();
  SolveResult result;
  result.z = z_guess;
  if (const auto reason = why_unsupported(nlp)) {
    result.message = *reason;
    return result;
  }
  StagewiseNlp& stages = *nlp.stagewise();
  std::optional<InteriorPoint> made;
  try {
    made.emplace(stages, options, nlp.use_threads(options.threads));
  } catch (...) {  // out of memory or threads
    result.message = thrown_error();
    return result;
  }
  InteriorPoint& method = *made;
  IterateFigures best;
  StageVectors best_stages;
  const auto watch = [&](int iteration, const IterateFigures& figures) -> std::optional<InteriorPoint::Ending> {
    using enum SolveStatus;
    if (is_better(figures, best, options.tolerance)) {
      best = figures;
      best_stages = method.stages();
    }
    if (options.on_iteration) {
      options.on_iteration(
          {iteration, figures.cost, figures.violation, figures.dual_violation, wall_seconds() - began});
    }
    if (options.on_iterate) options.on_iterate(stages.flat(method.stages()));
    if (options.interrupt && options.interrupt->load()) return {{interrupted, "stopped on request"}};
    if (wall_seconds() - began > options.max_seconds) return {{time_limit, "time limit reached"}};
    if (iteration >= options.max_iterations) return {{iteration_limit, "iteration limit reached"}};
    return std::nullopt;
  };
  const auto is_feasible = [&](const StageVectors& at) {
    const Eigen::VectorXd z = stages.flat(at);
    Eigen::VectorXd rows(nlp.num_constraints());
    nlp.constraints(z, rows);
    return constraint_violation(nlp, z, rows) <= options.tolerance;
  };
  InteriorPoint::Ending ending{SolveStatus::solver_failed, ""};
  try {
    ending = method.run(stages.stages(z_guess), watch, is_feasible);
  } catch (...) {
    ending.message = thrown_error();
  }
  result.status = ending.status;
  result.message = ending.message;
  result.iterations = method.iterations();
  result.pivoted_stages = method.pivoted_stages();
  const bool has_converged = result.status == SolveStatus::converged;
  if (has_converged || !best_stages.empty()) {
    result.z = stages.flat(has_converged ? method.stages() : best_stages);
    if (has_converged) result.stage_multipliers = method.multipliers();
    result.dual_violation = (has_converged ? method.figures() : best).dual_violation;
  }

  remeasure_result(nlp, options.tolerance, name(), result);
  result.times = method.times();
  result.times.cpu = cpu_seconds() - cpu_began;
  result.seconds = wall_seconds() - began;
  return result;
}

}  // namespace prowl
