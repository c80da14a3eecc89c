#pragma once

#include "prowl/motion/motion_problem.hpp"
#include "prowl/trajectory/trajectory.hpp"

namespace prowl {

/// Largest motion of contacts in stance over all nodes, from the planned q, v and a: the quantities
/// of contact rows, even if a program lacks them. In contrast, the certificate also checks v
/// between the nodes, and uses accelerations caused by the torques.
struct ContactMotion {
  double velocity = 0.0;      ///< |J v| [m/s]
  double acceleration = 0.0;  ///< |J a + J̇ v| [m/s²]
};

/// The nodes of the motion must match the phases of the problem.
ContactMotion contact_motion(const MotionProblem& problem, const Trajectory& motion);

}  // namespace prowl
