#include "prowl/plan_folder/checkpoint.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

#include "prowl/error.hpp"
#include "prowl/files/json_text.hpp"
#include "prowl/nlp/iterate.hpp"
#include "prowl/nlp/stopwatch.hpp"

namespace prowl {
namespace {

IterateFigures figures(const SolveResult& result) {
  return {result.cost, result.constraint_violation, result.dual_violation};
}

bool is_same_mesh(const Mesh& a, const Mesh& b) {
  const auto same_share = [](double one, double other) { return std::abs(one - other) < 1e-9; };  // rounding of a file
  const auto same = [&](const PhaseMesh& one, const PhaseMesh& other) {
    return one.intervals() == other.intervals() && std::ranges::equal(one.shares(), other.shares(), same_share);
  };
  return std::ranges::equal(a.phases, b.phases, same);
}

}  // namespace

Checkpoint::Checkpoint(std::filesystem::path folder, double every, PlanRecord so_far)
    : folder_(std::move(folder)), every_(every), best_(std::move(so_far)), next_(wall_seconds() + every) {
  check_plan_directory(folder_);
}

void Checkpoint::watch(std::function<void(Plan)>& on_iterate, std::function<void(const std::string& why)> on_failure) {
  on_failure_ = std::move(on_failure);
  on_iterate = [this, also = on_iterate](Plan iterate) {
    if (also) also(iterate);
    try {  // called from within a solver
      take(std::move(iterate));
    } catch (const std::exception& error) {
      on_failure_(error.what());
    }
  };
}

void Checkpoint::take(Plan iterate) {
  const bool is_new_mesh = best_.plan.trajectory.empty() || !is_same_mesh(iterate.mesh, best_.plan.mesh);
  if (is_new_mesh || is_better(figures(iterate.result), figures(best_.plan.result), best_.task.solver.tolerance)) {
    best_.plan = std::move(iterate);
    is_written_ = false;
  }
  if (!is_written_ && wall_seconds() >= next_) write();
}

void Checkpoint::write() {
  next_ = wall_seconds() + every_;  // also after a failure: a full disk stays full for a while
  write_plan(folder_, best_);
  next_ = wall_seconds() + every_;
  is_written_ = true;
}

void check_resumable(const PlanRecord& record, const Task& task, const std::vector<Mesh>& meshes) {
  const auto refuse = [](const std::string& reason) {
    throw InputError(reason + "; use --warm-start to start from it");
  };
  if (is_good(record.plan)) refuse("the plan is finished, nothing is left to resume");
  if (!record.plan.reasons.empty()) throw InputError("the task has no solution: " + record.plan.reasons.front());
  const auto compare = [&](const char* what, const std::string& then, const std::string& now) {
    if (then != as_utf8(now)) refuse(fmt::format("the {} is not the same as in the checkpoint", what));
  };
  compare("task file", record.task.task_file.text, task.task_file.text);
  compare("robot file", record.task.robot_file.text, task.robot_file.text);
  compare("URDF", as_utf8(record.task.problem.robot.description().urdf_text),
          task.problem.robot.description().urdf_text);
  const auto is_its_mesh = [&](const Mesh& mesh) { return is_same_mesh(mesh, record.plan.mesh); };
  if (meshes.empty() || std::ranges::any_of(meshes, is_its_mesh)) return;
  std::vector<int> intervals;
  for (const Mesh& mesh : meshes) intervals.push_back(mesh.num_intervals());
  refuse(fmt::format("the checkpoint is on a mesh of {} intervals; this solve uses meshes of {}",
                     record.plan.mesh.num_intervals(), fmt::join(intervals, ", ")));
}

}  // namespace prowl
