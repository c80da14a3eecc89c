#include "prowl/diagnosis/diagnosis.hpp"

#include <algorithm>
#include <optional>

#include "prowl/certificate/mesh_errors.hpp"
#include "prowl/diagnosis/diagnosis_run.hpp"
#include "prowl/diagnosis/helpful_changes.hpp"
#include "prowl/diagnosis/task_as_it_is.hpp"
#include "prowl/feasibility/feasibility.hpp"

namespace prowl {

bool holds_but_for_its_mesh(const Certificate& certificate) {
  constexpr double kMost = 100.0;  // times its limit: five times the intervals would remove this error
  const auto is_near = [](const CertificateCheck& check) { return check.passed || check.worst <= kMost * check.limit; };
  return fails_by_mesh_only(certificate) && std::ranges::all_of(certificate.checks, is_near);
}

Diagnosis diagnose(const DiscreteProblem& problem, const NlpSolver& solver, const NlpSolver& elastic_solver,
                   const DiagnosisOptions& options) {
  constexpr double kOwnPart =
      0.2;  // of the time, for a task without a solution on one of its meshes; go_on() adds the rest
  DiagnosisRun run(problem, solver, elastic_solver, options);
  TaskAsItIs as_it_is(run);
  Diagnosis& result = run.result;
  result.task_intervals = problem.mesh.num_intervals();
  result.reasons = proofs_of_infeasibility(problem.problem, problem.schedule);
  if (!result.reasons.empty()) {
    result.status = SolveStatus::infeasible;
    look_for_changes(run);
  } else if (const std::optional<Trajectory> motion = as_it_is.solve_all_meshes()) {
    as_it_is.plan(1.0);
    if (!result.solvable) as_it_is.take_from_own_mesh(*motion);
  } else {
    as_it_is.plan(kOwnPart);
    if (!result.solvable) look_for_changes(run);
    if (result.status == SolveStatus::time_limit) as_it_is.go_on();
  }
  result.interrupted = run.search.interrupted();
  if (!result.solvable && run.search.seconds_left() <= 0.0) result.out_of_time = true;
  return result;
}

}  // namespace prowl
