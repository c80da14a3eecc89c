#pragma once

#include <Eigen/Core>
#include <vector>

namespace prowl {

inline constexpr int kBaseDofs = 6;       ///< displacements and rotations of the base, first in v and in q's tangent
inline constexpr int kFirstRotation = 3;  ///< displacements of the base move the world, not the robot

/// Second derivatives of one scalar s(q, v, a), q in the tangent of configuration.hpp.
/// The scalars here are linear in a: s_va and s_aa vanish or are not needed.
struct SecondDerivatives {
  Eigen::MatrixXd qq, qv, vv, qa;  ///< nv x nv each; entry (i, j) of qv is d2 s / dq_i dv_j
  explicit SecondDerivatives(int nv);
  void set_zero();
};

/// Spatial vectors contain the velocity (force) at the world's origin in rows 0-2 and the angular velocity (moment) in
/// rows 3-5, world axes.
using SpatialVector = Eigen::Matrix<double, 6, 1>;
using SpatialColumns = Eigen::Matrix<double, 6, Eigen::Dynamic>;  ///< one per degree of freedom

/// Inertia about the world's origin, world axes.
struct WorldInertia {
  double mass = 0.0;           ///< [kg]
  Eigen::Vector3d moment;      ///< mass times centre of mass [kg m]
  Eigen::Matrix3d rotational;  ///< [kg m^2]

  SpatialVector operator*(const SpatialVector& motion) const;
};

/// A tree of bodies in motion, with by-products of the first derivatives of its inverse dynamics (docs/theory.md,
/// "Second derivatives of inverse dynamics"). Joint k turns about S_k, between body p before it and body k behind it. A
/// composite is all bodies behind a joint.
struct TreeMotion {
  struct Body {
    SpatialVector velocity;
    WorldInertia inertia, composite_inertia;
    Eigen::Matrix<double, 6, 3> composite_variation;  ///< B of the composite, its columns of angular velocities
  };
  std::vector<Body> bodies;
  SpatialColumns S;            ///< motion at v_k = 1
  SpatialColumns V, A;         ///< v_p x S,  a_p x S + v_p x V with gravity in a_p
  SpatialColumns W;            ///< v_p x S + v_k x S
  SpatialColumns I_S;          ///< I S            of the composite behind k
  SpatialColumns I_W_B_S;      ///< I W + B S
  SpatialColumns I_A_B_V_S_F;  ///< I A + B V + S x* F
};

/// Second derivatives of lambda . RNEA(q, v, a) in O(n depth): Singh, Russell, Wensing, "On second-order derivatives of
/// rigid-body dynamics", 2023, contracted inside the recursion, without tensors.
/// The tree has a floating base; all other joints have one degree of freedom.
class InverseDynamicsHessian {
 public:
  /// parents[i]: body before body i; -1 for the base, body 0. The base has degrees of freedom 0 ... 5, body i has
  /// number 5 + i.
  explicit InverseDynamicsHessian(std::vector<int> parents);

  /// Adds to the result.
  void add(const TreeMotion& tree, const Eigen::VectorXd& lambda, SecondDerivatives& result);

 private:
  /// Terms of one body; after propagate() summed over all bodies behind its joint, except m.
  struct Adjoint {
    SpatialVector m;            ///< velocity of the body at v = lambda
    SpatialVector H, P;         ///< I m;  v x* I m - I (v x m) - m x* I v
    Eigen::Matrix3d D_angular;  ///< D X = (0, -2 H_linear x X_linear + D_angular X_angular)
    SpatialVector D(const SpatialVector& X) const;
  };
  void propagate(const TreeMotion& tree, const Eigen::VectorXd& lambda);
  void add_base(const TreeMotion& tree, SecondDerivatives& result) const;
  void add_joint(const TreeMotion& tree, std::size_t body, SecondDerivatives& result) const;

  std::vector<int> parents_;
  std::vector<Adjoint> adjoints_;
  SpatialColumns N_;  ///< m_p x S
};

}  // namespace prowl
