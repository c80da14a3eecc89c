#pragma once

#include <Eigen/Core>
#include <vector>

#include "prowl/dynamics/rigid_body_terms.hpp"
#include "prowl/model/robot_model.hpp"

namespace prowl {

/// Bound on the distance of a contact point from the base: within `length` of `root`, a point of the base.
///
///   |p - (p_base + R_base root)| <= length
///
/// root is the origin of the first joint between the two; length sums the distances from joint to joint behind it, up
/// to the contact point. The bound holds for all angles of the joints, also beyond their limits.
struct ContactReach {
  Eigen::Vector3d root;  ///< base frame [m]
  double length = 0.0;   ///< [m]; infinite behind a prismatic joint without limits
  int first_joint = -1;  ///< index into RobotModel::joint_names(); -1 for a contact on the base itself
};
ContactReach contact_reach(const RobotModel& robot, int contact);

/// Bound on the distance of two points of bodies [m], for all angles of the joints, also beyond their limits: the way
/// along the joints between them. Infinite beyond a prismatic joint without limits.
double largest_distance(const RobotModel& robot, const BodyPoint& a, const BodyPoint& b);

/// A joint between the base and a contact point, and how fast it moves that point at most.
struct JointLever {
  int joint = 0;        ///< index into RobotModel::joint_names()
  double length = 0.0;  ///< |dp/dq| is at most this [m/rad]; 1 [-] for a prismatic joint
};
/// From the base outwards; a length is infinite if a prismatic joint without limits follows.
std::vector<JointLever> joint_levers(const RobotModel& robot, int contact);

/// Centre of mass and its velocity, world frame [m, m/s].
struct MassMotion {
  Eigen::Vector3d position, velocity;
};
MassMotion centre_of_mass(const RobotModel& robot, const Eigen::VectorXd& q, const Eigen::VectorXd& v);

/// The same for the centre of mass: within `radius` of `centre`, a point of the base.
struct MassReach {
  Eigen::Vector3d centre;  ///< base frame [m]
  double radius = 0.0;     ///< [m]
};
MassReach mass_reach(const RobotModel& robot);

}  // namespace prowl
