#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>

#include "prowl/refine.hpp"
#include "prowl/session/plan_record.hpp"

namespace prowl {

/// A warm start (see PlanOptions::warm_start) and its name in messages and in the record.
struct WarmStart {
  const PlanRecord* record = nullptr;  ///< null: no warm start
  bool resume = false;                 ///< continue this unfinished solve of the same task
  std::string folder = {};             ///< written into the new record; "" if there is none
  std::string option = {};             ///< prefix of messages: "--warm-start out/crouch"
};

/// Options of planning, common to all front ends.
struct PlanRequest {
  std::string solver;  ///< one of solver_names(); "" for the first
  int threads = 1;     ///< 1 to kMostThreads
  HessianKind hessian = HessianKind::exact;
  bool coarse_first = true;  ///< false: solve on the mesh of the task only
  /// Refine the mesh until its errors meet this; nullopt: that of grade draft if the task has no intervals, else not.
  std::optional<MeshTolerance> refine = {};
  WarmStart warm_start = {};
  bool gains = true;  ///< design feedback gains for a plan that is good

  // Callbacks during the solve; each may be empty, none may throw.
  const std::atomic<bool>* interrupt = nullptr;
  std::function<void(int intervals)> on_mesh = {};              ///< before a mesh is solved
  std::function<void(const SolveProgress&)> on_iteration = {};  ///< on the current mesh
  std::function<void(Plan iterate)> on_iterate = {};            ///< as PlanOptions::on_iterate
  std::function<void(const RefineRound&)> on_round = {};        ///< as RefineOptions::on_round
  std::function<bool(int done, int samples)> on_gain = {};      ///< return false to stop without gains
};

constexpr int kMostThreads = 256;

struct PlannedTask {
  PlanRecord record;
  bool interrupted = false;        ///< stopped early; with `refine` the plan may still be good
  bool robust_is_stopped = false;  ///< RobustPlan::is_stopped
  std::string why_no_gains;        ///< "" if gains exist or were not requested
};

const std::string& solver_name(const PlanRequest& request);  ///< of the request or the default

/// What the mesh is refined to; nullopt: it is not.
std::optional<MeshTolerance> refinement_goal(const PlanRequest& request, const Task& task);

/// Throws InputError for an unknown solver or more threads than it can use. plan_task() calls it,
/// too; call it earlier to fail before the task is read.
void check(const PlanRequest& request);

/// Plans a task and returns the record. All front ends call it. Throws what make_plan() throws, and
/// InputError if the warm start has another robot or other phases.
PlannedTask plan_task(Task task, const PlanRequest& request);

}  // namespace prowl
