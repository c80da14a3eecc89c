#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "prowl/starter/legs.hpp"

namespace prowl {

/// A knee: the joint that changes the distance between hip and foot most.
struct Knee {
  int joint = 0;          ///< index into RobotModel::joint_names
  double straight = 0.0;  ///< position at which the leg is longest [rad]
  double length = 0.0;    ///< largest distance from the hip to the contacts [m]
};

struct StandingPosture {
  bool found = false;
  Eigen::VectorXd joints;   ///< nu [rad], rounded to 1e-4; neutral_joints() if not found
  std::vector<Knee> knees;  ///< one per leg
  double stretch = 0.0;     ///< distance from hip to contacts over the leg's length [-]
  double height = 0.0;      ///< of the base above the ground [m]
};

/// A start posture by inverse kinematics: all contacts on level ground below the hips, knees bent
/// towards the middle of the robot (four legs or more) or forward (two legs), joints within their
/// limits, joints outside the legs as in neutral_joints(). On two legs the centre of mass is above
/// the middle of the contacts.
///
/// `robot` has the contacts; `contacts_of_leg[l]`: their indices for leg l. `found` is false if no
/// posture with bent knees reaches all contacts.
StandingPosture standing_posture(const RobotModel& robot, const LegSearch& search,
                                 const std::vector<std::vector<int>>& contacts_of_leg);

}  // namespace prowl
