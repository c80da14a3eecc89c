#include "prowl/diagnosis/diagnosis_run.hpp"

#include <fmt/format.h>

#include <utility>

#include "prowl/diagnosis/search_mesh.hpp"

namespace prowl {

DiagnosisRun::DiagnosisRun(const DiscreteProblem& problem_to_solve, const NlpSolver& solver_to_use,
                           const NlpSolver& elastic_solver, const DiagnosisOptions& diagnosis_options)
    : problem(problem_to_solve),
      solver(solver_to_use),
      elastic(elastic_solver),
      options(diagnosis_options),
      search(solver, options.solver, options.max_seconds),
      searched(problem.problem, search_mesh(problem)) {}

void DiagnosisRun::step(const std::string& what) const {
  if (options.on_step) options.on_step(what);
}

Plan DiagnosisRun::planned(const DiscreteProblem& of, double part, PlanOptions with, double seconds_before) const {
  with.solver = options.solver;
  with.elastic_solver = [this] { return &elastic; };
  with.solver.max_seconds = search.seconds_of_solve(part, options.solver.max_seconds - seconds_before);
  return make_plan(of, solver, with);
}

std::string DiagnosisRun::what_stopped(const SolveResult& plan) const {
  if (plan.status == SolveStatus::interrupted) return "interrupted";
  if (plan.status == SolveStatus::iteration_limit) {
    return fmt::format("stopped at solver.max_iterations ({})", options.solver.max_iterations);
  }
  if (plan.status != SolveStatus::time_limit) return "";
  return plan.seconds >= options.solver.max_seconds
             ? fmt::format("stopped at solver.max_time_s ({:g} s)", options.solver.max_seconds)
             : fmt::format("time ran out after {:.1f} s of planning", plan.seconds);
}

}  // namespace prowl
