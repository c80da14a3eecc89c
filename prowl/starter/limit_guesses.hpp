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

/// What takes the place of limits that the URDF lacks, or that limit nothing.
struct LimitGuess {
  std::string joint;
  std::optional<std::pair<double, double>> position;  ///< [rad]
  std::optional<double> velocity;                     ///< [rad/s]; only where the URDF's cannot be used at all
  std::optional<double> torque;                       ///< [N m]; the same
  bool torque_is_no_limit = false;                    ///< 1000 N m or more: left as it is, for the user to fill in
  bool is_knee = false;
};

/// Limits that a RobotModel takes, for joints whose limits it would refuse: as wide as can be. To look at the robot
/// with.
std::map<std::string, JointLimits> usable_limits(const UrdfOutline& outline);

/// For joints of legs: a range beyond +-2 pi becomes one that keeps a knee bent its own way, 0.1 rad from straight, and
/// other joints within 1.5 rad of the posture. For all: a range, velocity or torque that a RobotModel refuses is
/// replaced, torque by five times what standing takes. `standing_torque`: nu [N m].
std::vector<LimitGuess> guess_limits(const RobotModel& robot, const UrdfOutline& outline, const std::vector<Leg>& legs,
                                     const StandingPosture& posture, const Eigen::VectorXd& standing_torque);

}  // namespace prowl
