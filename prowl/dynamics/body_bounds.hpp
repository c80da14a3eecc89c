#pragma once

#include <Eigen/Core>

#include "prowl/model/robot_model.hpp"

namespace prowl {

/// How far a contact point can be from the base whatever the joints do: within `length` of `root`, a point of the base.
///
///   |p - (p_base + R_base root)| <= length
///
/// root is the origin of the first joint between the two, length the sum of the distances from joint to joint behind it
/// and to the contact point, so that it bounds all postures, also those that the joint limits forbid.
struct ContactReach {
  Eigen::Vector3d root;  ///< base frame [m]
  double length = 0.0;   ///< [m]; infinite behind a joint that slides without limits
  int first_joint = -1;  ///< index into RobotModel::joint_names(); -1 for a contact on the base itself
};
ContactReach contact_reach(const RobotModel& robot, int contact);

/// Centre of mass and its velocity, world frame [m, m/s].
struct MassMotion {
  Eigen::Vector3d position, velocity;
};
MassMotion centre_of_mass(const RobotModel& robot, const Eigen::VectorXd& q, const Eigen::VectorXd& v);

/// How far the centre of mass can be from the base whatever the joints do, likewise: within `radius` of `centre`, a
/// point of the base.
struct MassReach {
  Eigen::Vector3d centre;  ///< base frame [m]
  double radius = 0.0;     ///< [m]
};
MassReach mass_reach(const RobotModel& robot);

}  // namespace prowl
