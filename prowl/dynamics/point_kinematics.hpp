#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "prowl/dynamics/rigid_body_terms.hpp"

namespace prowl {

/// Position, Jacobian and acceleration of points of bodies, with exact first and second derivatives.
///
/// For the points p (3 rows each, world frame):
///   velocity      J(q) v                [m/s]
///   acceleration  g(q, v, a) = J a + J̇ v  [m/s^2], the classical (material) acceleration
///
/// Derivatives in q are with respect to the tangent of configuration.hpp. All follow from one rule for a chain of
/// joints, with d_j the velocity of p and w_j the angular velocity at v_j = 1: turning joint i moves everything behind
/// it as one rigid body, so for i at or before j in the chain  ∂d_j/∂q_i = w_i × d_j,  ∂w_j/∂q_i = w_i × w_j
/// (docs/theory.md). Directions of bodies obey it, too, with d_j = w_j × p.
class PointKinematics {
 public:
  /// In the order of the rows.
  explicit PointKinematics(std::vector<BodyPoint> points) : points_(std::move(points)) {}

  int rows() const { return 3 * static_cast<int>(points_.size()); }

  /// Takes the configuration at which `terms` was updated last.
  void set_configuration(const RigidBodyTerms& terms);

  const Eigen::VectorXd& positions() const { return positions_; }        ///< rows() [m]
  const Eigen::MatrixXd& jacobian() const { return jacobian_; }          ///< rows() x nv, for v
  const Eigen::MatrixXd& positions_dq() const { return positions_dq_; }  ///< rows() x nv, for the tangent of q

  /// Sets the motion (v, a) of the evaluations below. v = 0, a = u makes g = J u.
  void set_motion(const Eigen::VectorXd& v, const Eigen::VectorXd& a);
  const Eigen::VectorXd& acceleration() const { return acceleration_; }  ///< g, rows()
  void acceleration_dq(Eigen::MatrixXd& dg_dq) const;                    ///< rows() x nv
  void acceleration_dv(Eigen::MatrixXd& dg_dv) const;                    ///< rows() x nv; dg/da is jacobian()
  /// Adds the second derivatives of lambda . (J (a + velocity_gain v) + J̇ v) (lambda: rows()). The `a` of set_motion()
  /// must be the bracketed term.
  void add_acceleration_hessian(const Eigen::VectorXd& lambda, double velocity_gain, SecondDerivatives& result) const;
  /// Its block qq alone.
  void add_acceleration_hessian_qq(const Eigen::VectorXd& lambda, Eigen::Ref<Eigen::MatrixXd> qq) const;

  /// out(j, i) += ∂(Jᵀ f)_j / ∂q_i at fixed forces f (rows(), world frame). nv x nv.
  void add_force_derivative(const Eigen::VectorXd& f, Eigen::MatrixXd& out) const;
  /// out += scale * second derivative in q of lambda . positions. nv x nv, symmetric.
  void add_position_hessian(const Eigen::VectorXd& lambda, double scale, Eigen::Ref<Eigen::MatrixXd> out) const;

 protected:
  std::vector<BodyPoint> points_;

 private:
  /// One degree of freedom in the chain of one point; world axes.
  struct Link {
    int dof = 0;
    Eigen::Vector3d w, d;          ///< angular velocity behind the joint and velocity of p at v_j = 1
    Eigen::Vector3d omega, alpha;  ///< angular velocity and acceleration of the body before the joint
    Eigen::Vector3d omega_after;   ///< angular velocity of the body behind the joint
    Eigen::Vector3d dg_dq, dg_dv;  ///< derivatives of the acceleration of p

    /// Derivatives in q of omega and alpha behind the joint, in axes that turn with it.
    Eigen::Vector3d V() const { return omega.cross(w); }
    Eigen::Vector3d A() const { return alpha.cross(w) + omega.cross(omega.cross(w)); }
  };
  using Chain = std::vector<Link>;

  static void propagate_motion(Chain& chain, const Eigen::VectorXd& v, const Eigen::VectorXd& a,
                               Eigen::Ref<Eigen::VectorXd> acceleration);

  std::vector<Chain> chains_;
  Eigen::VectorXd positions_, acceleration_;
  Eigen::MatrixXd jacobian_, positions_dq_;
};

}  // namespace prowl
