#pragma once

#include "prowl/simulation/simulation.hpp"
#include "prowl/task_file/task.hpp"
#include "prowl/tracking/feedback_design.hpp"
#include "prowl/tracking/make_tracking_plan.hpp"

namespace prowl::test {

/// A plan followed in the simulator, with the tracking weights and criteria of its task.
inline SimulationResult simulated(const Task& task, const Trajectory& motion, const SimulationOptions& options = {}) {
  const Tracker tracker(make_tracking_plan(task.problem, design_feedback(task.problem, motion, task.tracking)));
  return simulate(task.problem, tracker, task.success, options);
}

}  // namespace prowl::test
