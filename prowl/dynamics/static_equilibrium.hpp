#pragma once

#include <Eigen/Core>
#include <vector>

#include "prowl/model/robot_model.hpp"

namespace prowl {

/// Torques and contact forces of a robot that stands still.
struct StaticEquilibrium {
  Eigen::VectorXd tau;    ///< nu [N m]
  Eigen::VectorXd force;  ///< 3 per contact of the ROBOT (robot order), world frame [N]; zero where inactive
  double residual = 0.0;  ///< what the contacts cannot balance [N], see below
};

/// Forces f of smallest norm that carry the robot's weight at rest, and the torques that go with them:
///
///   J_bᵀ f = g_b,   tau = g_j - J_jᵀ f
///
/// with g(q) the generalised gravity and J the Jacobian of the active contacts, split into base and joint columns.
/// Where no f balances the base (two point feet, one, none), f is the least-squares solution and
/// residual = |W (J_bᵀ f - g_b)|, W = diag(1, 1, 1, 1/L, 1/L, 1/L), L the RMS distance of the contacts from the base.
///
/// This is a guess, not a claim that the robot can stand: the smallest norm knows no friction cones. On level ground it
/// shares the weight by vertical forces, which may pull where the weight lies outside the support polygon; on a slope
/// it may leave the cone although other forces would not.
StaticEquilibrium static_equilibrium(const RobotModel& robot, const Eigen::VectorXd& q,
                                     const std::vector<int>& contacts);

/// The same in motion: with M a + h(q, v) in the place of g, and the load that the contacts cannot balance likewise.
StaticEquilibrium equilibrium_in_motion(const RobotModel& robot, const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                                        const Eigen::VectorXd& a, const std::vector<int>& contacts);

}  // namespace prowl
