#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "prowl/model/robot_model.hpp"

namespace prowl {

/// Positions of the contacts in the base frame, from the encoders alone.
class LegKinematics {
 public:
  explicit LegKinematics(const RobotModel& robot);
  LegKinematics(LegKinematics&&) noexcept;
  ~LegKinematics();

  /// `joints`: nu positions [rad].
  void update(const Eigen::VectorXd& joints);

  const Eigen::Vector3d& position(int contact) const { return positions_[contact]; }  ///< [m]
  /// Jacobians in the joints: of the point, and of the rotation of its link; 3 x nu, base axes.
  const Eigen::Matrix3Xd& linear(int contact) const { return linear_[contact]; }
  const Eigen::Matrix3Xd& angular(int contact) const { return angular_[contact]; }

 private:
  struct Workspace;
  std::unique_ptr<Workspace> workspace_;
  std::vector<Eigen::Vector3d> positions_;
  std::vector<Eigen::Matrix3Xd> linear_, angular_;
};

}  // namespace prowl
