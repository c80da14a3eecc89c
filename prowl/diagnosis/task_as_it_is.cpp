#include "prowl/diagnosis/task_as_it_is.hpp"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "prowl/mesh/mesh_levels.hpp"

namespace prowl {

std::optional<Trajectory> TaskAsItIs::solve_all_meshes() {
  std::vector<Mesh> meshes{run_.searched.mesh};
  for (Mesh& level : mesh_levels(run_.problem.problem, run_.problem.mesh)) {
    if (level.num_intervals() > meshes.front().num_intervals()) meshes.push_back(std::move(level));
  }
  std::optional<Trajectory> motion;
  for (Mesh& mesh : meshes) {
    run_.searched = DiscreteProblem(run_.problem.problem, std::move(mesh));
    run_.step(fmt::format("solving the task on {} intervals", run_.searched.mesh.num_intervals()));
    motion = run_.search.motion(run_.searched);
    if (!motion) break;
  }
  return motion;
}

void TaskAsItIs::plan(double part) {
  run_.step("planning the task");
  plan_ = run_.planned(run_.problem, part);
  take_outcome();
}

void TaskAsItIs::go_on() {
  if (!run_.search.may_go_on() || plan_.result.seconds >= run_.options.solver.max_seconds) return;
  run_.step("planning the task, from where it stopped");
  const double seconds_before = plan_.result.seconds;
  PlanOptions options;
  options.resume = !plan_.trajectory.empty();
  options.warm_start = std::move(plan_.trajectory);
  plan_ = run_.planned(run_.problem, 1.0, std::move(options), seconds_before);
  plan_.result.seconds += seconds_before;
  // A plan makes the changes useless, unless it fails by more than its mesh.
  if (plan_.result.status == SolveStatus::converged && holds_but_for_its_mesh(plan_.certificate)) {
    run_.result = {};
    run_.result.task_intervals = run_.problem.mesh.num_intervals();
  }
  take_outcome();
}

void TaskAsItIs::take_from_own_mesh(const Trajectory& motion) {
  run_.result.solvable = true;
  run_.result.certificate = certify(run_.problem, motion);
  const bool has_coarse_meshes = mesh_levels(run_.problem.problem, run_.problem.mesh).size() > 1;
  if (!run_.result.stopped_by.empty() || !has_coarse_meshes || !run_.search.may_go_on()) return;
  run_.step("planning the task on its own mesh only");
  PlanOptions options;
  options.coarse_first = false;
  Plan plan = run_.planned(run_.problem, 1.0, std::move(options));
  if (plan.result.status != SolveStatus::converged) return;
  run_.result.needs_one_mesh = true;
  run_.result.certificate = std::move(plan.certificate);
  run_.result.hints = std::move(plan.hints);
}

void TaskAsItIs::take_outcome() {
  run_.result.status = plan_.result.status;
  run_.result.message = plan_.result.message;
  run_.result.solvable = run_.result.status == SolveStatus::converged;
  run_.result.stopped_by = run_.what_stopped(plan_.result);
  run_.result.hints = plan_.hints;
  if (run_.result.solvable) run_.result.certificate = plan_.certificate;
}

}  // namespace prowl
