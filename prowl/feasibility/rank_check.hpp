#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "prowl/motion/motion_problem.hpp"
#include "prowl/trajectory/trajectory.hpp"

namespace prowl {

/// A posture in which the Jacobian of the contacts has a lower rank than in postures beside it: the legs are stretched,
/// say. Flat feet depend on each other in every posture and are none of these.
struct LostRank {
  int rank = 0;               ///< here
  int beside = 0;             ///< in postures nearby
  std::vector<int> contacts;  ///< that can push against each other without a torque of any joint, ascending
};

/// At configuration q, with these contacts held; nothing if no rank is lost there.
std::optional<LostRank> lost_rank(const RobotModel& robot, const Eigen::VectorXd& q, const std::vector<int>& contacts);

/// The same for the first node of each phase of a guess, in lines. A row that does not count there is left out for the
/// whole phase (phase_contacts), so that the contact drifts as soon as the legs bend.
std::vector<std::string> postures_that_lose_rank(const MotionProblem& problem, const Trajectory& guess);

}  // namespace prowl
