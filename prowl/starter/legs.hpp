#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "prowl/model/robot_model.hpp"

namespace prowl {

/// A chain of joints that ends in a foot.
struct Leg {
  std::vector<int> joints;  ///< from the hip to the foot; indices into RobotModel::joint_names
  int foot = 0;             ///< the body that stands on the ground; index into BodyTree::bodies
};

struct LegSearch {
  std::vector<Leg> legs;
  /// From the axes of the base to upright ones: the identity where z of the base points up.
  Eigen::Matrix3d upright = Eigen::Matrix3d::Identity();
  Eigen::Vector3d base_rpy = Eigen::Vector3d::Zero();  ///< the same [rad]
  std::vector<std::string> other_ends;                 ///< joints at the ends of other limbs: arms, head
};

/// The limbs that reach furthest down with all joints next to 0, seen from the base, are the legs: those whose ends are
/// within a quarter of the height of the lowest. Down is against z of the base; or, if nothing hangs down that way,
/// along another of its axes. Throws InputError if there are not two legs or more.
LegSearch find_legs(const RobotModel& robot);

}  // namespace prowl
