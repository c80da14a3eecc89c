#pragma once

// Reads [start] of a task file. Not installed: exposes toml++.
#include <Eigen/Core>
#include <optional>
#include <vector>

#include "prowl/motion/motion_problem.hpp"
#include "prowl/task_file/toml/toml_value.hpp"

namespace prowl {

/// Parts of the start that the file leaves to the optimiser, as bounds on their values; nullopt where it fixes them.
using StartChoices = std::vector<std::optional<TomlBounds>>;

/// Start of the motion, the reference of goals.
struct TaskStart {
  Eigen::VectorXd q;    ///< nq; contacts of the first phase stand where this puts them
  Eigen::VectorXd v;    ///< nv
  Eigen::Vector3d rpy;  ///< of the base [rad]; used for "free" angles of a goal
  StartChoices pose;    ///< nv: base position, turn about its axes from rpy, joints
  StartChoices speed;   ///< nv, as v
};

/// Throws InputError with the location of the key if a joint is outside its limits.
TaskStart read_start(const TomlTable& root, const RobotModel& robot, const SourceText& robot_file,
                     const std::vector<Surface>& surfaces);

/// Makes a start fit the contacts of the first phase: joints put contacts off their surfaces by up to 10 mm onto them,
/// and joint rates keep the contacts still. Without joint rates in the file these follow from the base; otherwise they
/// may move contacts by up to 0.05 m/s before. Where the base may vary, the joints between it and these contacts may,
/// too, unless the file names them. Throws InputError with the residual where that is not enough; larger gaps stay, for
/// validate() to refuse.
void fit_contacts(const TomlTable& root, const RobotModel& robot, const std::vector<Surface>& surfaces,
                  const Phase& first, TaskStart& start);

/// Boundary condition at the start.
BoundaryConstraint start_constraint(const RobotModel& robot, const TaskStart& start);

}  // namespace prowl
