#pragma once

#include <Eigen/Core>
#include <string>

#include "prowl/model/robot_model.hpp"
#include "prowl/trajectory/trajectory.hpp"

namespace prowl {

/// Scale (2 nv) of each coordinate of the state x = (q in its tangent, v):
///
///   1 + max over the nodes of |x_i|      (Betts, Practical Methods for Optimal Control, section 4.7.4)
///
/// with q relative to the first node, so the scale is independent of the position in the world.
Eigen::VectorXd state_scale(const Trajectory& trajectory);

/// x1 ⊖ x0 (2 nv), each coordinate divided by its scale.
Eigen::VectorXd scaled_difference(const Eigen::VectorXd& q0, const Eigen::VectorXd& v0, const Eigen::VectorXd& q1,
                                  const Eigen::VectorXd& v1, const Eigen::VectorXd& scale);

/// Name of a tangent coordinate, 0 <= i < nv: "base x", "base rotation x", "lf_hfe_joint", ...
std::string coordinate_name(const RobotModel& robot, Eigen::Index i);
/// Name of a state coordinate, 0 <= i < 2 nv; the second half: "velocity of base x", ...
std::string state_name(const RobotModel& robot, Eigen::Index i);

}  // namespace prowl
