#pragma once

#include <Eigen/Core>
#include <vector>

#include "prowl/dynamics/contact_kinematics.hpp"
#include "prowl/dynamics/projector.hpp"
#include "prowl/dynamics/rigid_body_terms.hpp"

namespace prowl {

/// Gains that pull a contact back to its place: e = J a + J̇ v + kd J v + kp (p - anchor).
struct ContactStabilisation {
  double kd = 0.0;  ///< [1/s]
  double kp = 0.0;  ///< [1/s^2]
};

/// Where the inverse form is evaluated; a = dv/dt, tau the joint torques, one anchor (3 rows, world) a contact.
struct DynamicsPoint {
  Eigen::VectorXd q, v, a, tau;
  Eigen::VectorXd anchors;
  ContactStabilisation stabilisation;
};

/// First derivatives of a vector y(q, v, a, tau); q in the tangent of configuration.hpp.
struct PointDerivatives {
  Eigen::MatrixXd q, v, a, tau;
};

/// Second derivatives of a scalar s(q, v, a, tau) that is linear in a and tau: the blocks that are not zero.
struct PointHessian {
  Eigen::MatrixXd qq, qv, qa, qtau, vv;
};

/// Inverse form of the projected dynamics (docs/theory.md, after Pardo et al. 2016, eq. (9), (11)):
///
///   r = M a + h - S' tau                        equations of motion, contact forces left out        [N, N m]
///   e = J a + J̇ v + kd J v + kp (p - anchor)    contact acceleration, stabilised                    [m/s^2]
///   f = (J J')⁺ (J r - s e)                     contact forces, minimum norm, world frame           [N]
///   c = r - J' f  =  P r + s J⁺ e               n + 6 rows
///
/// c = 0 if and only if the projected equations of motion P r = 0 and the contact condition J J⁺ e = 0 hold; s, the
/// mass of the robot [kg], only gives both the unit of a force. Any set of contacts: none, or redundant ones, where J
/// loses rank and f is the choice of least norm (first derivatives hold at constant rank).
/// One object holds the work space of one thread; results stay until the next evaluation.
class ProjectedResidual {
 public:
  ProjectedResidual(const RobotModel& robot, std::vector<int> contacts);

  const std::vector<int>& contacts() const { return kinematics_.contacts(); }

  /// c and f. Throws NumericalError if they are not finite.
  void evaluate(const DynamicsPoint& point);
  /// The same, and their exact first derivatives (also away from c = 0).
  void evaluate_with_derivatives(const DynamicsPoint& point);

  const Eigen::VectorXd& residual() const { return c_; }       ///< nv
  const Eigen::VectorXd& forces() const { return f_; }         ///< 3 per contact of the set, world frame
  const PointDerivatives& residual_derivatives() const { return dc_; }  ///< nv rows
  const PointDerivatives& force_derivatives() const { return df_; }     ///< 3 rows a contact
  int rank() const { return projector_.rank(); }               ///< of J
  bool has_full_rank() const { return rank() == kinematics_.rows(); }

  /// Hessian of mu . c + nu . f at fixed mu (nv) and nu (3 a contact), at the point of the last evaluate_with_derivatives.
  /// Needs J of full rank.
  const PointHessian& hessian(const DynamicsPoint& point, const Eigen::VectorXd& mu, const Eigen::VectorXd& nu);

  /// Positions of the contacts of the set at the last evaluation, and their derivatives.
  const ContactKinematics& kinematics() const { return kinematics_; }
  /// Kinematics of the whole robot at the last evaluation.
  const RigidBodyTerms& terms() const { return terms_; }

 private:
  void compute_forces(const DynamicsPoint& point);

  double mass_;
  RigidBodyTerms terms_;
  ContactKinematics kinematics_;
  Projector projector_;
  Eigen::VectorXd r_, e_, c_, f_;
  PointDerivatives dc_, df_;
  PointHessian hessian_;
  SecondDerivatives second_, kinematic_second_;
  Eigen::MatrixXd work_m_, work_n_;
};

}  // namespace prowl
