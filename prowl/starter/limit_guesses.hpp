#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "prowl/model/robot_model.hpp"
#include "prowl/model/urdf/urdf_outline.hpp"
#include "prowl/starter/standing_posture.hpp"

namespace prowl {

/// Replacements for limits that the URDF lacks, or that limit nothing.
struct LimitGuess {
  std::string joint;
  std::optional<std::pair<double, double>> position;  ///< [rad]
  std::optional<double> velocity;                     ///< [rad/s]; only if the URDF's is unusable
  std::optional<double> torque;                       ///< [N m]; likewise
  bool torque_is_no_limit = false;                    ///< 1000 N m or more: kept, for the user to fill in
  bool is_knee = false;
};

/// The widest limits that RobotModel accepts, for joints whose limits it would reject; for a first
/// look at the robot.
std::map<std::string, JointLimits> usable_limits(const UrdfOutline& outline);

/// Legs: a range beyond ±2π is replaced; knees keep their side, at least 0.1 rad from straight,
/// other joints stay within 1.5 rad of the posture. All joints: a range, velocity or torque that
/// RobotModel rejects is replaced, torque by five times `standing_torque` (nu) [N m].
std::vector<LimitGuess> guess_limits(const RobotModel& robot, const UrdfOutline& outline, const std::vector<Leg>& legs,
                                     const StandingPosture& posture, const Eigen::VectorXd& standing_torque);

}  // namespace prowl
