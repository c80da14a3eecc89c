#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "prowl/model/body_placements.hpp"
#include "prowl/model/body_tree.hpp"
#include "prowl/model/robot_model.hpp"
#include "prowl/model/urdf/link_tree.hpp"

namespace prowl {

/// Forward kinematics of a robot whose base stays at the origin, turned so that z is up.
class RobotPose {
 public:
  /// Keeps a reference to the robot. `upright`: from the axes of the base to those of the world.
  RobotPose(const RobotModel& robot, const Eigen::Matrix3d& upright);

  /// `joints`: nu positions [rad].
  void set(const Eigen::VectorXd& joints);

  const Eigen::VectorXd& q() const { return q_; }  ///< nq
  const RobotModel& robot() const { return robot_; }
  const BodyTree& tree() const { return tree_; }
  const std::vector<RobotLink>& links() const { return links_; }
  const Eigen::Isometry3d& body(int index) const { return (*bodies_)[index]; }
  Eigen::Vector3d point(int body_index, const Eigen::Vector3d& in_body) const { return body(body_index) * in_body; }
  Eigen::Vector3d contact(std::size_t index) const;  ///< of robot().contacts() [m]
  /// Of a joint: the origin of the body that it moves [m].
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

/// The joint positions next to 0 that are well within the limits: 0.1 rad, or a tenth of the range, from both ends.
Eigen::VectorXd neutral_joints(const RobotModel& robot);

}  // namespace prowl
