#pragma once

// Reads [[goal]] of a task file. Not installed: exposes toml++.
#include <optional>

#include "prowl/mesh/mesh.hpp"
#include "prowl/motion/motion_problem.hpp"
#include "prowl/task_file/task_start.hpp"
#include "prowl/task_file/toml/toml_value.hpp"

namespace prowl {

/// Goal of a gait: at the end of the last phase the base is at rest, displaced from the start
/// (world frame [m]) and turned by a rotation vector (world frame [rad]); legs are free.
BoundaryConstraint arrival(const RobotModel& robot, const TaskStart& start, const Eigen::Vector3d& displacement,
                           const Eigen::Vector3d& rotation, int num_phases);

/// One condition per [[goal]], at a node of the mesh, which has equal steps in each phase; at any time without a mesh.
std::vector<BoundaryConstraint> read_goals(const TomlTable& root, const RobotModel& robot, const TaskStart& start,
                                           const std::vector<Phase>& phases, const std::optional<Mesh>& mesh);

}  // namespace prowl
