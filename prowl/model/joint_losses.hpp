#pragma once

#include <Eigen/Core>

namespace prowl {

/// Torque that joints lose, from `<dynamics>` of the URDF. The torques of a plan move the links; motors give
/// this in addition (docs/robot-file.md).
struct JointLosses {
  Eigen::VectorXd damping;       ///< nu [N m s/rad]
  Eigen::VectorXd dry_friction;  ///< nu, of a joint that moves [N m]

  /// Faster joints have nearly all of their dry friction [rad/s, m/s].
  static constexpr double kSlow = 0.05;

  bool of(int joint) const { return damping(joint) > 0.0 || dry_friction(joint) > 0.0; }
  bool any() const { return damping.any() || dry_friction.any(); }

  /// Of one joint at this rate [N m], with dry friction smoothed by tanh over kSlow, and its derivatives.
  double torque(int joint, double rate) const;
  double slope(int joint, double rate) const;
  double curvature(int joint, double rate) const;

  Eigen::VectorXd torques(const Eigen::VectorXd& rates) const;  ///< of all joints (nu)
};

}  // namespace prowl
