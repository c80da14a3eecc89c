#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "prowl/model/robot_model.hpp"

namespace prowl {

/// A chain of joints that ends in a foot.
struct Leg {
  std::vector<int> joints;  ///< from the hip to the foot; indices into RobotModel::joint_names
  int foot = 0;             ///< body on the ground; index into BodyTree::bodies
};

struct LegSearch {
  std::vector<Leg> legs;
  /// Rotation from base axes to upright axes; identity if z of the base points up.
  Eigen::Matrix3d upright = Eigen::Matrix3d::Identity();
  Eigen::Vector3d base_rpy = Eigen::Vector3d::Zero();  ///< the same as roll, pitch, yaw [rad]
  std::vector<std::string> other_ends;                 ///< joints at the ends of other limbs: arms, head
};

/// Finds the legs with all joints near 0: the limbs whose ends are within a quarter of the height
/// of the lowest. Down is -z of the base or, if no limb hangs that way, another of its axes. Throws
/// InputError if it finds fewer than two legs.
LegSearch find_legs(const RobotModel& robot);

}  // namespace prowl
