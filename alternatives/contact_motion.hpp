#pragma once

#include "prowl/motion/motion_problem.hpp"
#include "prowl/trajectory/trajectory.hpp"

namespace prowl {

/// How far a motion is from keeping its contacts still, by its own q, v and a: worst contact that is held, worst node.
/// What the contact rows of a program ask for, whether it has them or not. The certificate looks at v between the nodes
/// too, and at the accelerations that the torques cause in place of the planned ones.
struct ContactMotion {
  double velocity = 0.0;      ///< |J v| [m/s]
  double acceleration = 0.0;  ///< |J a + J̇ v| [m/s²]
};

/// The nodes of the motion have to fit the phases of the problem.
ContactMotion contact_motion(const MotionProblem& problem, const Trajectory& motion);

}  // namespace prowl
