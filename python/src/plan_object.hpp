#pragma once

#include <memory>
#include <optional>

#include "motion.hpp"
#include "prowl/plan_folder/plan_folder.hpp"
#include "prowl/tracker/tracker.hpp"

namespace prowl::python {

/// prowl.Plan: a plan with its arrays and its tracker. Immutable.
struct PlanObject {
  explicit PlanObject(PlanRecord plan_record, std::optional<std::filesystem::path> directory = {});

  const MotionProblem& problem() const { return record.task.problem; }

  PlanRecord record;
  Motion motion;
  std::shared_ptr<const Tracker> tracker;          ///< null: no gains
  std::optional<std::filesystem::path> read_from;  ///< the folder, unless solved here
};

}  // namespace prowl::python
