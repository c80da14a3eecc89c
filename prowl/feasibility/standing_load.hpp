#pragma once

#include <Eigen/Core>
#include <vector>

#include "prowl/motion/motion_problem.hpp"
#include "prowl/nlp/nlp_solver.hpp"

namespace prowl {

/// Share of its weight that a robot can carry at rest in one posture on some contacts:
///
///   maximise s <= 1   subject to   J_bᵀ f = s g_b,   f in the friction cones,   lower <= s g_j - J_jᵀ f <= upper
///
/// g is gravity, J the contact Jacobian, split into base and joints; the limits are those of joint torques at rest. It
/// is a linear program: each cone is a pyramid of 16 edges around it, at most 2 % wider, so s is never too small.
struct StandingLoad {
  bool solved = false;            ///< the solver found the largest s
  double share = 0.0;             ///< s; below 1 the robot cannot stand still here
  Eigen::VectorXd torque_needed;  ///< nu [N m], for the whole weight: tau / s; empty if s is 0
};
StandingLoad standing_load(const MotionProblem& problem, const Eigen::VectorXd& q,
                           const std::vector<PhaseContact>& contacts, const NlpSolver& solver);

}  // namespace prowl
