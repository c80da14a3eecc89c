#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "prowl/plan.hpp"
#include "prowl/robust/robust_plan.hpp"
#include "prowl/task_file/task.hpp"
#include "prowl/tracking/feedback_design.hpp"

namespace prowl {

/// One solver iteration and its mesh level; 0 is the coarsest.
struct MeshIteration {
  int level = 0;
  SolveProgress progress = {};
};

/// A plan with its task, software versions and history.
struct PlanRecord {
  Task task;
  Plan plan;                                    ///< files omit z and the multipliers of the result
  std::map<std::string, std::string> versions;  ///< "prowl" -> "0.1.0", "Ipopt" -> ...
  std::optional<FeedbackDesign> feedback = {};  ///< gains, if designed; not read back: see Tracker::read
  std::optional<Robustness> robustness = {};    ///< of the plan, if the task asks for it and the nominal plan is good
  std::vector<MeshIteration> iterations = {};   ///< of all meshes, in order; empty if not recorded
  std::string warm_start = {};                  ///< folder of the warm start; "" without one
};

}  // namespace prowl
