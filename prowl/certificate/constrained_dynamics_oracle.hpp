#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "prowl/model/robot_model.hpp"

namespace prowl {

/// Forward dynamics with contact points held fixed: the second opinion of the certificate, which shares no code and no
/// method with prowl/dynamics. By Gauss's principle of least constraint: of all accelerations that the contacts allow,
/// the one nearest to that without contacts, in the metric of the mass matrix M = L L':
///
///   x = L' a,  b = L⁻¹ (S' τ - h),  A = J L⁻ᵀ:     min |x - b|²  over  min |A x + J̇v|²,     A' f = x - b
///
/// J may be rank deficient (flat feet): a is still unique, f is the one of least norm. No damping, no stabilisation.
/// One oracle, one thread.
class ConstrainedDynamicsOracle {
 public:
  /// `contacts`: indices into robot.contacts() that are held fixed. Keeps a reference to `robot`.
  ConstrainedDynamicsOracle(const RobotModel& robot, const std::vector<int>& contacts);
  ConstrainedDynamicsOracle(ConstrainedDynamicsOracle&&) noexcept;
  ~ConstrainedDynamicsOracle();

  struct Motion {
    Eigen::VectorXd a;      ///< nv, rate of v
    Eigen::VectorXd force;  ///< 3 per contact of the robot, world frame [N]; zero where not held
    double residual = 0.0;  ///< largest entry of |J a + J̇v| [m/s²]; not small: the contacts contradict each other
  };
  Motion evaluate(const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& tau);

  /// The part of `force` (3 per contact of the robot) that does nothing to the robot, J' part = 0, at the configuration
  /// of the last evaluate(): what a planner may choose. Exactly zero where the contacts are independent.
  Eigen::VectorXd internal_part(const Eigen::VectorXd& force) const;

  struct ContactPoints {
    Eigen::Matrix3Xd position;  ///< of every contact of the robot, world frame [m]
    Eigen::Matrix3Xd velocity;  ///< world frame [m/s]
  };
  ContactPoints contact_points(const Eigen::VectorXd& q, const Eigen::VectorXd& v);

 private:
  struct Workspace;
  std::unique_ptr<Workspace> workspace_;
};

}  // namespace prowl
