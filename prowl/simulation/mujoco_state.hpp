#pragma once

#include <Eigen/Core>

namespace prowl {

// A state of the robot as MuJoCo has it, in the model of physics.hpp. Joints are in the same order on both sides.

/// Base position in the world [m], quaternion w x y z, joints; q as in RobotModel (x y z w).
Eigen::VectorXd mujoco_qpos(const Eigen::VectorXd& q);

/// Linear velocity of the base in WORLD axes [m/s], angular in base axes [rad/s], joint rates; v as in RobotModel (both
/// in base axes).
Eigen::VectorXd mujoco_qvel(const Eigen::VectorXd& q, const Eigen::VectorXd& v);

}  // namespace prowl
