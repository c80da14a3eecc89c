#pragma once

#include <Eigen/Core>
#include <vector>

#include "prowl/dynamics/forward_dynamics.hpp"

namespace prowl {

/// First-order projected dynamics about a state (docs/tracking.md#linearisation):
///
///   d/dt dx = A dx + B dtau,   C dx = 0
///
/// dx = (dq, dv), 2 nv entries: dq in the tangent of configuration.hpp (base displacement in the
/// world, rotation vector in the base frame, joints), dv the velocity difference. Contact forces
/// are eliminated. The 2 rank J independent rows of C state that contacts neither leave their
/// footholds nor move. A keeps C dx = 0, and C B = 0. One object holds the work space of one
/// thread; results stay valid until the next evaluation.
class LinearisedDynamics {
 public:
  /// `contacts`: indices of contacts of the robot in stance, possibly redundant.
  LinearisedDynamics(const RobotModel& robot, std::vector<int> contacts);

  /// Throws NumericalError if the dynamics are not finite.
  void evaluate(const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& tau);

  const Eigen::MatrixXd& A() const { return A_; }                ///< 2 nv x 2 nv
  const Eigen::MatrixXd& B() const { return B_; }                ///< 2 nv x nu
  const Eigen::MatrixXd& C() const { return C_; }                ///< 2 rank J x 2 nv
  const ForwardDynamics& dynamics() const { return dynamics_; }  ///< at the state of the last evaluation

  /// Z (2 nv x n) with C Z = 0 and Z' diag(weight) Z = I: basis of the deviations that the contacts
  /// allow, orthonormal in the metric of `weight` (2 nv, > 0).
  Eigen::MatrixXd consistent_directions(const Eigen::VectorXd& weight) const;

  /// `weight` (2 nv) with this share of it on the joints that move a contact in stance.
  Eigen::VectorXd with_stance_legs(Eigen::VectorXd weight, double share) const;

  /// Critically damped impedance of the contacts in stance, F (nu x 2 nv): joint torques -F dx accelerate a contact
  /// with the displacement e by -rate² e / 4 - rate e', if the base stays. `rates`: one per contact [1/s]. F dx = 0 for
  /// every deviation that the contacts allow. Singular directions (straight legs) are damped.
  Eigen::MatrixXd impedance(const Eigen::VectorXd& rates);

  /// Effect L of landing on a deviation, dx -> L dx with C L = 0 (2 nv x 2 nv). Positions move to
  /// the nearest that the contacts allow, in the metric of `weight`: a foot stays where it lands.
  /// Velocities change by an impact without rebound: impulses stop the contact points, M dv+ = M dv
  /// + J' impulse.
  Eigen::MatrixXd landing(const Eigen::VectorXd& weight);

 private:
  ForwardDynamics dynamics_;
  RigidBodyTerms terms_;
  ContactKinematics kinematics_;
  Eigen::VectorXd q_, v_;
  Eigen::MatrixXd A_, B_, C_;
  Eigen::MatrixXd turned_velocity_;  ///< derivative of the contacts' velocities in q
};

/// Velocity (nv) after contacts close at (q, v), without rebound: minimises the kinetic energy of
/// the change.
Eigen::VectorXd velocity_after_landing(const RobotModel& robot, const std::vector<int>& contacts,
                                       const Eigen::VectorXd& q, const Eigen::VectorXd& v);

}  // namespace prowl
