#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "prowl/starter/legs.hpp"

namespace prowl {

/// A knee: the joint that changes the distance from the hip to the foot most.
struct Knee {
  int joint = 0;          ///< index into RobotModel::joint_names
  double straight = 0.0;  ///< where the leg is longest [rad]
  double length = 0.0;    ///< of the leg then, from the hip to the contacts [m]
};

struct StandingPosture {
  bool found = false;
  Eigen::VectorXd joints;   ///< nu, rounded to 1e-4 rad; neutral ones if not found
  std::vector<Knee> knees;  ///< one a leg
  double stretch = 0.0;     ///< distance from hip to contacts, of the leg's length [-]
  double height = 0.0;      ///< of the base over the ground [m]
};

/// A posture to start from, by inverse kinematics: all contacts level on the ground, below the hips, legs bent at knees
/// that point to the middle of the robot on four legs or more and forward on two; all joints within their limits, those
/// that are not of a leg as near to 0 as is well within them. On two legs the centre of mass is over the middle of the
/// contacts.
///
/// `robot` has the contacts; `contacts_of_leg[l]` are the indices of those of leg l. Not found where no posture with
/// bent knees brings all contacts to their places.
StandingPosture standing_posture(const RobotModel& robot, const LegSearch& search,
                                 const std::vector<std::vector<int>>& contacts_of_leg);

}  // namespace prowl
