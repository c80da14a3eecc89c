#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "prowl/model/body_placements.hpp"
#include "prowl/model/body_tree.hpp"
#include "prowl/model/robot_model.hpp"
#include "prowl/model/urdf/link_tree.hpp"

namespace prowl {

/// Forward kinematics with the base at the origin, turned so that z is up.
class RobotPose {
 public:
  /// Keeps a reference to the robot. `upright`: rotation from base to world axes.
  RobotPose(const RobotModel& robot, const Eigen::Matrix3d& upright);

  /// `joints`: nu positions [rad].
  void set(const Eigen::VectorXd& joints);

  const Eigen::VectorXd& q() const { return q_; }  ///< nq
  const RobotModel& robot() const { return robot_; }
  const BodyTree& tree() const { return tree_; }
  const std::vector<RobotLink>& links() const { return links_; }
  const Eigen::Isometry3d& body(int index) const { return (*bodies_)[index]; }
  Eigen::Vector3d point(int body_index, const Eigen::Vector3d& in_body) const { return body(body_index) * in_body; }
  Eigen::Vector3d contact(std::size_t index) const;  ///< contact of robot(), world frame [m]
  /// Origin of the body that the joint moves, world frame [m].
  Eigen::Vector3d joint(int index) const { return body(index + 1).translation(); }
  Eigen::Vector3d center_of_mass() const;

 private:
  const RobotModel& robot_;
  BodyTree tree_;
  std::vector<RobotLink> links_;
  BodyPlacements placements_;
  Eigen::VectorXd q_;
  const std::vector<Eigen::Isometry3d>* bodies_ = nullptr;
};

/// Joint positions (nu) closest to 0 at a distance of 0.1 rad, or a tenth of the range, from the
/// limits.
Eigen::VectorXd neutral_joints(const RobotModel& robot);

}  // namespace prowl
