#pragma once

#include "prowl/certificate/constrained_dynamics_oracle.hpp"
#include "prowl/trajectory/trajectory.hpp"

namespace prowl {

/// True accelerations and forces from the torques at a point of the motion. If contacts are redundant, the part of the
/// forces without effect on the robot is the planner's (linear between nodes).
inline ConstrainedDynamicsOracle::Motion true_motion(const TrajectoryPoint& point,
                                                     ConstrainedDynamicsOracle& dynamics) {
  auto motion = dynamics.evaluate(point.q, point.v, point.tau);
  motion.force += dynamics.internal_part(point.force);
  return motion;
}

}  // namespace prowl
