#pragma once

#include <optional>
#include <string>
#include <vector>

#include "prowl/motion/motion_problem.hpp"
#include "prowl/tracking/rollout.hpp"
#include "prowl/trajectory/tracking_error.hpp"

namespace prowl {

/// What one contact of the robot had to give while it stood. In a rollout contacts hold whatever that is: where the
/// force pulls, or leaves the friction cone, a foot on the ground would have lifted or slipped.
struct ContactLoad {
  bool stood = false;               ///< at any sample; if not, the rest says nothing
  double least_normal_force = 0.0;  ///< [N]; < 0: it pulled
  double least_normal_time = 0.0;   ///< [s]
  double beyond_cone = 0.0;         ///< largest |ft| - mu max(fn, 0) [N]; > 0: outside the cone
  double beyond_cone_time = 0.0;    ///< [s]
};

/// How well a rollout followed its plan, and what that took.
struct RolloutMeasures {
  ErrorMeasure base_position, base_angle, joints;  ///< as of TrackingError
  double largest_torque_share = 0.0;               ///< of the limit
  std::string largest_torque_joint;
  double saturated = 0.0;             ///< share of the samples in which some torque is at its limit
  double positive_work = 0.0;         ///< of the joints [J]
  std::vector<ContactLoad> contacts;  ///< one a contact of the robot
};

/// Measures at the samples of a rollout; "at rest" is the last kRestWindow before `end` [s], when it should have ended.
/// `friction` of all surfaces, in place of their own.
RolloutMeasures measure_rollout(const MotionProblem& problem, const Tracker& tracker, const Rollout& rollout,
                                double end, std::optional<double> friction);

}  // namespace prowl
