#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "prowl/plan.hpp"
#include "prowl/task_file/task.hpp"
#include "prowl/tracking/feedback_design.hpp"

namespace prowl {

/// One iteration of the solver, and on which mesh: 0 is the first, the coarsest.
struct MeshIteration {
  int level = 0;
  SolveProgress progress = {};
};

/// A plan, what it was made from, and by what.
struct PlanRecord {
  Task task;
  Plan plan;                                    ///< of the result, z and multipliers are not kept in files
  std::map<std::string, std::string> versions;  ///< "prowl" -> "0.1.0", "Ipopt" -> ...
  std::optional<FeedbackDesign> feedback = {};  ///< gains, if there are; not read back: Tracker::read does
  std::vector<MeshIteration> iterations = {};   ///< of all meshes, in order; empty if nobody wrote them down
  std::string warm_start = {};                  ///< folder of the plan that it started from; "" if from the task alone
};

}  // namespace prowl
