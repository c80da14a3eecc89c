#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "prowl/motion/motion_problem.hpp"
#include "prowl/trajectory/trajectory.hpp"

namespace prowl {

/// A posture in which the contact Jacobian has lower rank than in nearby postures, for example with stretched legs.
/// Flat feet are dependent in every posture and do not count.
struct LostRank {
  int rank = 0;               ///< in this posture
  int beside = 0;             ///< in postures nearby
  std::vector<int> contacts;  ///< that can push against each other without joint torques, ascending
};

/// At configuration q with these contacts held; none if no rank is lost.
std::optional<LostRank> lost_rank(const RobotModel& robot, const Eigen::VectorXd& q, const std::vector<int>& contacts);

/// The same for the first node of each phase of a guess, one line each. A dependent row there is left out for the whole
/// phase (phase_contacts), so the contact drifts as soon as the legs bend.
std::vector<std::string> postures_that_lose_rank(const MotionProblem& problem, const Trajectory& guess);

}  // namespace prowl
