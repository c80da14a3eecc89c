#pragma once

#include <Eigen/Core>

namespace prowl {

// Conversion of states to MuJoCo's convention (model of physics.hpp). Joint order is the same.

/// qpos (nq): base position, world frame [m]; quaternion w x y z; joints. q as in RobotModel (x y z
/// w).
Eigen::VectorXd mujoco_qpos(const Eigen::VectorXd& q);

/// qvel (nv): base velocity, linear in WORLD axes [m/s], angular in base axes [rad/s]; joint rates.
/// v as in RobotModel (both in base axes).
Eigen::VectorXd mujoco_qvel(const Eigen::VectorXd& q, const Eigen::VectorXd& v);

}  // namespace prowl
