#pragma once

#include <Eigen/Core>
#include <vector>

#include "prowl/motion/motion_problem.hpp"
#include "prowl/nlp/nlp_solver.hpp"

namespace prowl {

/// How much of its weight a robot can carry when it stands still in one posture on some contacts:
///
///   maximise s <= 1   subject to   J_bᵀ f = s g_b,   f in the friction cones,   lower <= s g_j - J_jᵀ f <= upper
///
/// g is gravity, J the contact Jacobian, split into base and joints, the limits those of the joints' torques at rest. A
/// linear program: each cone is a pyramid of 16 edges around it, 2 % wider at most, so that s is never too small
/// because of it.
struct StandingLoad {
  bool solved = false;            ///< the solver has found the largest s
  double share = 0.0;             ///< s; below 1 the robot cannot stand still here
  Eigen::VectorXd torque_needed;  ///< nu [N m], with the same forces and all of the weight: tau / s; empty if s is 0
};
StandingLoad standing_load(const MotionProblem& problem, const Eigen::VectorXd& q,
                           const std::vector<PhaseContact>& contacts, const NlpSolver& solver);

}  // namespace prowl
