#pragma once

#include <vector>

#include "prowl/model/robot_model.hpp"
#include "prowl/mpc/contact_timeline.hpp"

namespace prowl {

/// The largest kick [m/s] after which a linear inverted pendulum with the robot's height can still come to rest, if it
/// may put a point foot once per half stride as far as the legs reach. The kick comes in the middle of a step, from
/// rest above the foot. Koolen et al., Capturability-based analysis and control of legged locomotion, IJRR 2012:
/// infinitely many steps.
///
/// The reach is that of a stretched leg at standing height `height` [m], from below its hip to either side. Joint
/// limits, which reduce the bound, and feet that stand already, which raise it, are left out.
double pendulum_bound(const RobotModel& robot, const std::vector<std::vector<int>>& feet, double height,
                      const SteppingPattern& pattern);

}  // namespace prowl
