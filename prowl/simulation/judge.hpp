#pragma once

#include <string>
#include <vector>

#include "prowl/motion/motion_problem.hpp"
#include "prowl/simulation/simulation.hpp"

namespace prowl {

/// SuccessCriteria::distance for this robot [m].
double allowed_distance(const RobotModel& robot, const SuccessCriteria& criteria);
/// Delay of a landing or lift-off that its criterion allows [s].
double allowed_delay(const ContactSwitch& change, const SuccessCriteria& criteria);

/// Criteria that a run violates, in words. After a fall or a divergence these alone: the rest follows from them.
std::vector<std::string> failures(const SimulationResult& result, const MotionProblem& problem,
                                  const SuccessCriteria& criteria);

/// Criteria that the base at rest at the end violates, in words.
std::vector<std::string> failures_in_rest(const ErrorMeasure& base_position, const ErrorMeasure& base_angle,
                                          const SuccessCriteria& criteria);

}  // namespace prowl
