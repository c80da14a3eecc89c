#pragma once

#include "prowl/certificate/constrained_dynamics_oracle.hpp"
#include "prowl/trajectory/trajectory.hpp"

namespace prowl {

/// What the torques of a point of the motion really cause. Where contacts are redundant the motion does not tell the
/// forces: these then have the planner's choice for the part that does nothing to the robot (linear between nodes).
inline ConstrainedDynamicsOracle::Motion true_motion(const TrajectoryPoint& point,
                                                     ConstrainedDynamicsOracle& dynamics) {
  auto motion = dynamics.evaluate(point.q, point.v, point.tau);
  motion.force += dynamics.internal_part(point.force);
  return motion;
}

}  // namespace prowl
