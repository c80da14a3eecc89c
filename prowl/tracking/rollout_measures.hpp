#pragma once

#include <optional>
#include <string>
#include <vector>

#include "prowl/motion/motion_problem.hpp"
#include "prowl/tracking/rollout.hpp"
#include "prowl/trajectory/tracking_error.hpp"

namespace prowl {

/// Load of one contact during its stances. Contacts of a rollout always hold: where the force pulls
/// or leaves the friction cone, a real foot would lift or slip.
struct ContactLoad {
  bool stood = false;               ///< in stance at any sample; if not, the rest is undefined
  double least_normal_force = 0.0;  ///< [N]; < 0: it pulled
  double least_normal_time = 0.0;   ///< [s]
  double beyond_cone = 0.0;         ///< largest |ft| - mu max(fn, 0) [N]; > 0: outside the cone
  double beyond_cone_time = 0.0;    ///< [s]
};

/// Tracking errors and effort of a rollout.
struct RolloutMeasures {
  ErrorMeasure base_position, base_angle, joints;  ///< see TrackingError
  double largest_torque_share = 0.0;               ///< of the limit
  std::string largest_torque_joint;
  double saturated = 0.0;             ///< share of the samples with a torque at its limit
  double positive_work = 0.0;         ///< of the joints [J]
  std::vector<ContactLoad> contacts;  ///< per contact of the robot
};

/// Measures at the samples of a rollout. "At rest" is the last kRestWindow before `end`, the
/// planned end [s]. `friction`: coefficient of all surfaces, if given.
RolloutMeasures measure_rollout(const MotionProblem& problem, const Tracker& tracker, const Rollout& rollout,
                                double end, std::optional<double> friction);

}  // namespace prowl
