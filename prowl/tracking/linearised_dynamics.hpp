#pragma once

#include <Eigen/Core>
#include <vector>

#include "prowl/dynamics/forward_dynamics.hpp"

namespace prowl {

/// The projected dynamics about a state, to first order (docs/tracking.md#linearisation):
///
///   d/dt dx = A dx + B dtau,   C dx = 0
///
/// dx = (dq, dv), 2 nv entries: dq in the tangent of configuration.hpp at the state (displacement of the base in the
/// world, rotation vector in its frame, joints), dv the difference of velocities. Contact forces are eliminated. The
/// rows of C, 2 rank J of them, independent: a contact point that holds neither leaves its place nor moves. What A does
/// to a dx with C dx = 0 keeps it so, and C B = 0. One object holds the work space of one thread; results stay until
/// the next evaluation.
class LinearisedDynamics {
 public:
  /// `contacts`: indices of contacts of the robot that hold. Redundant ones are allowed.
  LinearisedDynamics(const RobotModel& robot, std::vector<int> contacts);

  /// Throws NumericalError if the dynamics are not finite.
  void evaluate(const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& tau);

  const Eigen::MatrixXd& A() const { return A_; }  ///< 2 nv x 2 nv
  const Eigen::MatrixXd& B() const { return B_; }  ///< 2 nv x nu
  const Eigen::MatrixXd& C() const { return C_; }  ///< 2 rank J x 2 nv

  /// Z (2 nv x n) with C Z = 0 and Z' diag(weight) Z = I: all deviations that the contacts allow, orthonormal in the
  /// metric of the weights (2 nv, > 0).
  Eigen::MatrixXd consistent_directions(const Eigen::VectorXd& weight) const;

  /// What landing at this state does to a deviation: dx -> L dx with C L = 0 (2 nv x 2 nv). Positions go to the nearest
  /// that the contacts allow, in the metric of the weights: the place of a foot is where it lands. Velocities change by
  /// an impact without rebound: the contacts' impulses stop the contact points, M dv+ = M dv + J' impulse.
  Eigen::MatrixXd landing(const Eigen::VectorXd& weight);

 private:
  ForwardDynamics dynamics_;
  RigidBodyTerms terms_;
  ContactKinematics kinematics_;
  Eigen::VectorXd q_, v_;
  Eigen::MatrixXd A_, B_, C_;
};

/// The impact of landing itself: the velocity after contacts have closed at (q, v), without rebound. It minimises the
/// kinetic energy of the change.
Eigen::VectorXd velocity_after_landing(const RobotModel& robot, const std::vector<int>& contacts,
                                       const Eigen::VectorXd& q, const Eigen::VectorXd& v);

}  // namespace prowl
