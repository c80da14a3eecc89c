#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "prowl/model/robot_model.hpp"

namespace prowl {

/// Placements of a robot's bodies, by Pinocchio's forward kinematics. One object holds the work space of one thread.
class BodyPlacements {
 public:
  explicit BodyPlacements(const RobotModel& robot);
  ~BodyPlacements();
  BodyPlacements(BodyPlacements&&) noexcept;

  /// World placements of the bodies, in the order of BodyTree::bodies; q as in RobotModel. Valid until the next call.
  const std::vector<Eigen::Isometry3d>& at(const Eigen::VectorXd& q);

 private:
  struct Workspace;  // Pinocchio's model and Data
  std::unique_ptr<Workspace> workspace_;
  std::vector<Eigen::Isometry3d> placements_;
};

}  // namespace prowl
