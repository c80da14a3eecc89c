#pragma once

#include <Eigen/Core>
#include <vector>

#include "prowl/model/robot_model.hpp"

namespace prowl {

/// Torques and contact forces of a robot that stands still.
struct StaticEquilibrium {
  Eigen::VectorXd tau;    ///< nu [N m]
  Eigen::VectorXd force;  ///< 3 per contact of the ROBOT (robot order), world frame [N]; zero where inactive
  double residual = 0.0;  ///< load that the contacts cannot balance [N], see below
};

/// Forces f of smallest norm that carry the robot's weight at rest, and the torques that go with them:
///
///   J_bᵀ f = g_b,   tau = g_j - J_jᵀ f
///
/// with g(q) the generalised gravity and J the Jacobian of the active contacts, split into base and joint columns.
/// If no f balances the base (two point feet, one, none), f is the least-squares solution and
/// residual = |W (J_bᵀ f - g_b)|, W = diag(1, 1, 1, 1/L, 1/L, 1/L), L the RMS distance of the contacts from the base.
///
/// The result does not prove that the robot can stand: it ignores friction cones. On level ground the forces are
/// vertical, and some pull if the centre of mass is outside the support polygon; on a slope they may leave the cone
/// although other forces would not.
StaticEquilibrium static_equilibrium(const RobotModel& robot, const Eigen::VectorXd& q,
                                     const std::vector<int>& contacts);

/// The same in motion, with M a + h(q, v) in place of g.
StaticEquilibrium equilibrium_in_motion(const RobotModel& robot, const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                                        const Eigen::VectorXd& a, const std::vector<int>& contacts);

}  // namespace prowl
