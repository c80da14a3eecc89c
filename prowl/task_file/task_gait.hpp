#pragma once

// Reads [gait] of a task file. Not installed: exposes toml++.
#include <optional>
#include <vector>

#include "prowl/task_file/task_goals.hpp"
#include "prowl/task_file/toml/toml_value.hpp"

namespace prowl {

/// Where the strides of a gait take the base: the sum of all, world frame.
struct Travel {
  Eigen::Vector3d displacement;  ///< [m]
  Eigen::Vector3d rotation;      ///< rotation vector, before the start orientation [rad]
};

/// Phases, intervals and travel of [gait].
struct TaskGait {
  std::vector<Phase> phases;
  std::vector<int> intervals;    ///< of each phase; empty if the file does not say
  std::optional<Travel> travel;  ///< nullopt if the file has goals, or strides that repeat
  std::optional<Cycle> cycle;    ///< of these
  Eigen::VectorXd cycle_start;   ///< nq, with the feet where such a stride begins
};

/// Nullopt if the file has no [gait]. Throws InputError for errors in it, for an additional
/// [[phase]], and for robots without four feet.
std::optional<TaskGait> read_gait(const TomlTable& root, const RobotModel& robot, const std::vector<Surface>& surfaces,
                                  const TaskStart& start);

}  // namespace prowl
