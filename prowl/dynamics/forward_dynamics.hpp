#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <vector>

#include "prowl/dynamics/contact_kinematics.hpp"
#include "prowl/dynamics/projector.hpp"
#include "prowl/dynamics/rigid_body_terms.hpp"

namespace prowl {

/// Forward form of the projected dynamics: accelerations and contact forces from torques
/// (docs/theory.md#forward-form, after Pardo et al. 2016 with the missing P restored):
///
///   a = Mc⁻¹ ( P (S' τ − h) + M C v ),   Mc = M + P M − (P M)',   C v = −J⁺ J̇ v     [m/s², rad/s²], base frame
///   f = J⁺' (M a + h − S' τ)                                                       [N], world frame
///
/// C v is dP/dt v if J v = 0; otherwise it keeps J J⁺ (J a + J̇ v) = 0. The set of contacts may be empty or redundant;
/// then a is still unique and f has least norm.
/// One object holds the work space of one thread; results stay until the next evaluation. evaluate() allocates only at
/// first, and where the rank of J changes.
class ForwardDynamics {
 public:
  /// First derivatives of a vector y(q, v, τ); q in the tangent of configuration.hpp.
  struct Derivatives {
    Eigen::MatrixXd q, v, tau;
  };

  /// `contacts`: indices of contacts of the robot, in the order of the forces. `rank_threshold`: see
  /// Projector::compute.
  ForwardDynamics(const RobotModel& robot, std::vector<int> contacts,
                  double rank_threshold = Projector::kRankThreshold);

  /// a and f. Throws NumericalError if they are not finite.
  void evaluate(const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& tau);
  /// The same, with exact first derivatives, also if J v ≠ 0. The rank of J must be constant around q.
  void evaluate_with_derivatives(const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& tau);

  const Eigen::VectorXd& acceleration() const { return a_; }           ///< a, nv
  const Eigen::VectorXd& forces() const { return f_; }                 ///< f, 3 per contact, world frame
  const Derivatives& acceleration_derivatives() const { return da_; }  ///< nv rows
  const Derivatives& force_derivatives() const { return df_; }         ///< 3 rows per contact
  const Projector& projector() const { return projector_; }            ///< of J at the last evaluation
  /// Change of a and f by generalised forces on the robot besides the torques, one column each.
  struct Response {
    Eigen::MatrixXd acceleration;  ///< nv rows
    Eigen::MatrixXd forces;        ///< 3 rows per contact
  };
  Response response(const Eigen::MatrixXd& applied) const;  ///< nv rows

 private:
  void add_turn_of_lost_acceleration(Eigen::MatrixXd& dg_dq) const;
  void add_turn_of_force_space(Eigen::MatrixXd& df_dq);

  RigidBodyTerms terms_;
  ContactKinematics kinematics_;
  Projector projector_;
  double rank_threshold_;
  Eigen::MatrixXd P_, pinv_;                               // P, J⁺
  Eigen::PartialPivLU<Eigen::MatrixXd> constrained_mass_;  // of Mc
  Eigen::VectorXd a_, f_;
  Eigen::MatrixXd PM_;  // P M
  Eigen::VectorXd zero_, applied_, pulled_, driven_, left_;
  Derivatives da_, df_;
};

/// Rank threshold [m] for states slightly off their contacts: between nodes, of a rollout, of an estimator.
inline constexpr double kContactRankThreshold = 1e-4;

}  // namespace prowl
