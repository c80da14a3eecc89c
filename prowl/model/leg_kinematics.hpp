#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "prowl/model/robot_model.hpp"

namespace prowl {

/// Where the contacts of a robot are as its encoders see them: in the base frame, whatever the base does.
class LegKinematics {
 public:
  explicit LegKinematics(const RobotModel& robot);
  LegKinematics(LegKinematics&&) noexcept;
  ~LegKinematics();

  /// `joints`: nu positions [rad].
  void update(const Eigen::VectorXd& joints);

  const Eigen::Vector3d& position(int contact) const { return positions_[contact]; }  ///< [m]
  /// Of the point, and of the turning of the link that it is fixed to, in the joints; 3 x nu, base axes.
  const Eigen::Matrix3Xd& linear(int contact) const { return linear_[contact]; }
  const Eigen::Matrix3Xd& angular(int contact) const { return angular_[contact]; }

 private:
  struct Workspace;
  std::unique_ptr<Workspace> workspace_;
  std::vector<Eigen::Vector3d> positions_;
  std::vector<Eigen::Matrix3Xd> linear_, angular_;
};

}  // namespace prowl
