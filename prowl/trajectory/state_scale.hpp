#pragma once

#include <Eigen/Core>
#include <string>

#include "prowl/model/robot_model.hpp"
#include "prowl/trajectory/trajectory.hpp"

namespace prowl {

/// The scale of each coordinate of the state x = (q in its tangent, v), 2 nv of them:
///
///   1 + max over the nodes of |x_i|      (Betts, Practical Methods for Optimal Control, section 4.7.4)
///
/// with q taken from the first node, so that it does not matter where in the world the motion happens.
Eigen::VectorXd state_scale(const Trajectory& trajectory);

/// x1 - x0, each coordinate divided by its scale; the configurations' part by prowl::difference.
Eigen::VectorXd scaled_difference(const Eigen::VectorXd& q0, const Eigen::VectorXd& v0, const Eigen::VectorXd& q1,
                                  const Eigen::VectorXd& v1, const Eigen::VectorXd& scale);

/// "base x", "base rotation x", "lf_hfe_joint", ... for 0 <= i < nv: a coordinate of the tangent.
std::string coordinate_name(const RobotModel& robot, Eigen::Index i);
/// The same for a coordinate of the state, 0 <= i < 2 nv: "velocity of base x" in its second half.
std::string state_name(const RobotModel& robot, Eigen::Index i);

}  // namespace prowl
