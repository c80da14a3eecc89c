#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>

#include "prowl/refine.hpp"
#include "prowl/session/plan_record.hpp"

namespace prowl {

/// A plan to start from (see PlanOptions::start_from), and what to call it in messages and in the record.
struct PlanStart {
  const PlanRecord* record = nullptr;  ///< null: start from the task alone
  bool resume = false;                 ///< the record is an unfinished solve of the same task: go on with it
  std::string folder = {};             ///< for the record; "" if it is in no folder
  std::string option = {};             ///< that names it, for messages: "--warm-start out/crouch"
};

/// What a user chooses when a task is planned, whatever the front end is.
struct PlanRequest {
  std::string solver;  ///< one of solver_names(); "" for the first
  int threads = 1;     ///< 1 to kMostThreads
  HessianKind hessian = HessianKind::exact;
  bool coarse_first = true;                  ///< false: on the mesh of the task at once
  std::optional<MeshTolerance> refine = {};  ///< meshes that follow the errors until these are met
  PlanStart start = {};
  bool gains = true;  ///< design feedback gains for a plan that is good

  // While it solves; each may be empty. None may throw.
  const std::atomic<bool>* interrupt = nullptr;
  std::function<void(int intervals)> on_mesh = {};              ///< before a mesh is solved
  std::function<void(const SolveProgress&)> on_iteration = {};  ///< of the mesh that is being solved
  std::function<void(Plan iterate)> on_iterate = {};            ///< as PlanOptions::on_iterate
  std::function<void(const RefineRound&)> on_round = {};        ///< as RefineOptions::on_round
  std::function<bool(int done, int samples)> on_gain = {};      ///< false: stop, without gains
};

constexpr int kMostThreads = 256;

struct PlannedTask {
  PlanRecord record;
  bool interrupted = false;  ///< before the end; the plan may be a good one all the same, if its mesh was refined
  std::string why_no_gains;  ///< "" if they were not asked for, or are there
};

const std::string& solver_name(const PlanRequest& request);  ///< one of solver_names()

/// Throws InputError if the request makes no sense: a solver that does not exist, threads that it cannot use. Without
/// it plan_task() throws the same, but only once the task is read.
void check(const PlanRequest& request);

/// From a task to a record of its plan: the one way that all front ends take. Throws as make_plan() does, InputError if
/// the plan to start from is of another robot or has other phases.
PlannedTask plan_task(Task task, const PlanRequest& request);

}  // namespace prowl
