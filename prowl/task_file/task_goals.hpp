#pragma once

// Reads [[goal]] of a task file. Not installed: shows toml++.
#include "prowl/mesh/mesh.hpp"
#include "prowl/motion/motion_problem.hpp"
#include "prowl/task_file/toml/toml_value.hpp"

namespace prowl {

/// Where goals are measured from.
struct TaskStart {
  Eigen::VectorXd q;    ///< nq
  Eigen::Vector3d rpy;  ///< of the base [rad]; what "free" angles of a goal are taken from
};

/// The condition that fixes the start, at rest.
BoundaryCondition start_condition(const RobotModel& robot, const Eigen::VectorXd& q);

/// The goal of a gait: at the end of the last phase the base is displaced from the start by so much (world frame [m]),
/// at rest, turned as at the start; the legs as they like.
BoundaryCondition arrival(const RobotModel& robot, const TaskStart& start, const Eigen::Vector3d& displacement,
                          int num_phases);

/// One condition for each [[goal]] of the file, at a node of the mesh, which has equal steps in each phase.
std::vector<BoundaryCondition> read_goals(const TomlTable& root, const RobotModel& robot, const TaskStart& start,
                                          const std::vector<Phase>& phases, const Mesh& mesh);

}  // namespace prowl
