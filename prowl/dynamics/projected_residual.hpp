#pragma once

#include <Eigen/Core>
#include <vector>

#include "prowl/dynamics/contact_kinematics.hpp"
#include "prowl/dynamics/projector.hpp"
#include "prowl/dynamics/rigid_body_terms.hpp"
#include "prowl/linear_algebra/matrix_kernels.hpp"

namespace prowl {

/// Gains that pull a contact back to its anchor: e = J a + J̇ v + kd J v + kp (p - anchor).
struct ContactStabilisation {
  double kd = 0.0;  ///< [1/s]
  double kp = 0.0;  ///< [1/s^2]
};

/// Point of evaluation: a = dv/dt, tau joint torques, anchors 3 rows per contact, world frame [m].
struct DynamicsPoint {
  Eigen::VectorXd q, v, a, tau;
  Eigen::VectorXd anchors;
  ContactStabilisation stabilisation;
  Eigen::VectorXd chosen_forces;  ///< w, one per row of `chosen_rows` [N]
};

/// First derivatives of a vector y(q, v, a, tau, w, e); q in the tangent of configuration.hpp. e is the stabilised
/// contact acceleration (all rows of the set) as an independent input: the derivative in the anchors is -kp times that
/// in e. gains: kd and kp.
struct PointDerivatives {
  Eigen::MatrixXd q, v, a, tau, w, e, gains;
};

/// Second derivatives of a scalar s(q, v, a, tau, w, e, kd, kp) that is linear in all but q and v: the non-zero blocks.
/// The block of kp and the anchors is -de and not stored.
struct PointHessian : SecondDerivatives {
  using SecondDerivatives::SecondDerivatives;
  Eigen::MatrixXd qtau, qw, qe;
  Eigen::MatrixXd qgains, vgains;  ///< two columns, kd and kp
  Eigen::VectorXd de;              ///< first derivative of s in e
};

/// Inverse form of the projected dynamics (docs/theory.md, after Pardo et al. 2016, eq. (9), (11)):
///
///   r = M a + h - S' tau                        equations of motion, contact forces left out        [N, N m]
///   e = J a + J̇ v + kd J v + kp (p - anchor)    contact acceleration, stabilised                    [m/s^2]
///   f = (J J')⁺ (J r - s e)                     contact forces, minimum norm, world frame           [N]
///   c = r - J' f  =  P r + s J⁺ e               n + 6 rows
///
/// c = 0 if and only if the projected equations of motion P r = 0 and the contact condition J J⁺ e = 0 hold. s, a
/// hundredth of the robot's mass [kg], only weighs one against the other (the projection mixes forces and moments in SI
/// units). Away from c = 0, f depends on s, less for smaller s. The set of contacts may be empty or redundant; then J
/// loses rank and f has least norm (first derivatives hold at constant rank).
///
/// `chosen_rows` of redundant contacts are rows of J that depend on the others. Their forces w become inputs, their
/// rows of e are left out, and the other forces follow: f = Z w plus a particular force covers all forces with the same
/// effect. c = 0 keeps its solutions if the omitted rows of e agree with the others. One object holds the work space of
/// one thread; results stay until the next evaluation.
class ProjectedResidual {
 public:
  ProjectedResidual(const RobotModel& robot, std::vector<int> contacts, std::vector<int> chosen_rows = {});

  const std::vector<int>& contacts() const { return kinematics_.contacts(); }

  const std::vector<int>& chosen_rows() const { return chosen_rows_; }

  double contact_weight() const { return contact_weight_; }  ///< s [kg]

  /// c and f. Throws NumericalError if they are not finite.
  void evaluate(const DynamicsPoint& point);
  /// The same, with exact first derivatives, also away from c = 0.
  void evaluate_with_derivatives(const DynamicsPoint& point);

  const Eigen::VectorXd& residual() const { return c_; }                ///< nv
  const Eigen::VectorXd& forces() const { return f_; }                  ///< 3 per contact of the set, world frame
  const PointDerivatives& residual_derivatives() const { return dc_; }  ///< nv rows
  const PointDerivatives& force_derivatives() const { return df_; }     ///< 3 rows per contact
  int rank() const { return projector_.rank(); }                        ///< of the rows of J that are not chosen
  bool has_full_rank() const { return projector_.full_rank(); }

  /// Hessian of mu . c + nu . f at fixed mu (nv) and nu (3 per contact), at the point of the last
  /// evaluate_with_derivatives(). Throws NumericalError unless has_full_rank().
  const PointHessian& hessian(const DynamicsPoint& point, const Eigen::VectorXd& mu, const Eigen::VectorXd& nu);

  /// Positions of the contacts of the set at the last evaluation, and their derivatives.
  const ContactKinematics& kinematics() const { return kinematics_; }
  /// Kinematics of the whole robot at the last evaluation.
  const RigidBodyTerms& terms() const { return terms_; }

 private:
  void compute_forces(const DynamicsPoint& point);
  void compute_gram_inverse();
  void add_redundancy();

  MatrixKernels kernels_;
  double contact_weight_;
  RigidBodyTerms terms_;
  ContactKinematics kinematics_;
  std::vector<int> chosen_rows_, kept_rows_;
  Projector projector_;           ///< of the kept rows
  Eigen::MatrixXd kept_;          ///< those rows of J, if not all
  Eigen::MatrixXd gram_inverse_;  ///< (J J')⁺ of the kept rows, zero in the chosen ones
  Eigen::VectorXd r_, e_, c_, f_;
  PointDerivatives dc_, df_;
  PointHessian hessian_;
  // Work space, so that nothing is allocated after the first evaluation.
  Eigen::MatrixXd Jt_;       ///< J'
  Eigen::MatrixXd A_q_;      ///< derivative of the equations of motion in q with f fixed
  Eigen::MatrixXd K_;        ///< (J J')⁺ J
  Eigen::MatrixXd e_gains_;  ///< derivative of e in the gains
  Eigen::MatrixXd work_m_, work_n_, rhs_, cross_;
  Eigen::MatrixXd Gt_, Nt_;  ///< of hessian(): G' and N'
  Eigen::VectorXd l1_, l2_, work_v_, work_f_, zero_;
};

}  // namespace prowl
