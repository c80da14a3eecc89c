#pragma once

// Reads [gait] of a task file. Not installed: shows toml++.
#include <optional>
#include <vector>

#include "prowl/mesh/mesh.hpp"
#include "prowl/task_file/task_goals.hpp"
#include "prowl/task_file/toml/toml_value.hpp"

namespace prowl {

/// What [gait] stands for.
struct TaskGait {
  std::vector<Phase> phases;
  Mesh mesh;
  std::optional<Eigen::Vector3d> displacement;  ///< of the base at the end [m]; none if the file has goals of its own
};

/// None if the file has no [gait]. Throws InputError on anything wrong in it, on [[phase]] beside it, and if the robot
/// is not one on four legs.
std::optional<TaskGait> read_gait(const TomlTable& root, const RobotModel& robot, const std::vector<Surface>& surfaces,
                                  const TaskStart& start);

}  // namespace prowl
