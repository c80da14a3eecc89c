#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "prowl/model/robot_model.hpp"

namespace prowl {

/// Forward dynamics with contact points held fixed, for the certificate. It shares no code or method with
/// prowl/dynamics. Gauss's principle of least constraint: among the accelerations that the contacts allow, a is nearest
/// to the free one in the metric of the mass matrix M = L L':
///
///   x = L' a,  b = L⁻¹ (S' τ - h),  A = J L⁻ᵀ:     min |x - b|²  over  min |A x + J̇v|²,     A' f = x - b
///
/// J may be rank deficient (flat feet): a is still unique, f has least norm. No damping, no stabilisation.
/// Not thread-safe: use one oracle per thread.
class ConstrainedDynamicsOracle {
 public:
  /// `contacts`: indices into robot.contacts() that are held fixed. Keeps a reference to `robot`.
  ConstrainedDynamicsOracle(const RobotModel& robot, const std::vector<int>& contacts);
  ConstrainedDynamicsOracle(ConstrainedDynamicsOracle&&) noexcept;
  ~ConstrainedDynamicsOracle();

  struct Motion {
    Eigen::VectorXd a;      ///< nv, rate of v
    Eigen::VectorXd force;  ///< 3 per contact of the robot, world frame [N]; zero where not held
    double residual = 0.0;  ///< largest entry of |J a + J̇v| [m/s²]; large if the contacts contradict each other
  };
  Motion evaluate(const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& tau);
  /// Only the acceleration of evaluate(), which is faster.
  Eigen::VectorXd acceleration(const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& tau);

  /// The part of `force` (3 per contact of the robot) without effect on the robot, J' part = 0, at the configuration of
  /// the last evaluate() or acceleration(). Exactly zero if the contacts are independent.
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
