#pragma once

#include <Eigen/Core>

#include "prowl/transcription/base_defects.hpp"
#include "prowl/transcription/rotation_product.hpp"

namespace prowl {

/// s = h/2 of the interval on one side of a node (0 without one) [s], and its dependence on the
/// duration T of the phase.
struct HalfTime {
  double s = 0.0;
  double slope = 0.0;  ///< ds/dT
  int column = -1;     ///< index of T among the variables of the node; -1 if T is fixed
};

/// The trapezoid is explicit in a state halfway between two nodes. From the state (z, w) before a
/// node to the node:
///
///   v = w + s a,   R = R_z exp(s omega),   p = p_z + s R v_linear,   joints = joints_z + s rates
///
/// Variables: (base position, theta, joints | v | a | ... | shared), R = chart exp(theta); the
/// state stores z and w in place of q and v, all else is equal. docs/transcription.md, "Stage by
/// stage".
///
/// The linearised map pulls gradients and Hessians back.
class Arrival {
 public:
  /// Sets the state at which the rest is evaluated.
  void set(const Eigen::Matrix3d& chart, int nv, const HalfTime& time, const Eigen::VectorXd& state,
           const Eigen::VectorXd& correction);

  /// Variables of the node.
  const Eigen::VectorXd& node() const { return node_; }
  /// Inverse map: the state that leads to these variables of a node.
  static Eigen::VectorXd state(const Eigen::Matrix3d& chart, int nv, double s, const Eigen::VectorXd& node,
                               const Eigen::VectorXd& correction);

  /// Turns derivatives in the node's variables (one row per function) into those in the state's.
  void pull_back(Eigen::MatrixXd& rows) const;
  void pull_back(Eigen::VectorXd& gradient) const;
  /// A row that depends on one entry of each of q (a joint), v, a, and on the duration alone.
  struct JointRow {
    double q = 0.0, v = 0.0, a = 0.0, duration = 0.0;
  };
  /// The same for such a row; `dof` (0 ... nv - 1): the entry, one of the base only if q = 0.
  JointRow pull_back(JointRow row, Eigen::Index dof) const;
  /// The same for a quadratic form: m -> A' m A, A = d node / d state. Here and below, the lower triangle counts;
  /// above it m is undefined afterwards.
  void pull_back_form(Eigen::MatrixXd& m) const;
  /// The same for the Hessian of a function with its gradient in the node's variables
  /// (overwritten).
  void pull_back_hessian(Eigen::MatrixXd& hessian, Eigen::VectorXd& gradient) const;

 private:
  template <class Matrix>
  void substitute_position(Matrix&& m) const;
  template <class Matrix>
  void substitute_joints(Matrix&& m) const;
  template <class Matrix>
  void substitute_rotation(Matrix&& m) const;
  template <class Matrix>
  void substitute_velocity(Matrix&& m) const;
  void substitute_position_in_form(Eigen::MatrixXd& m) const;
  void substitute_joints_in_form(Eigen::MatrixXd& m) const;
  void substitute_rotation_in_form(Eigen::MatrixXd& m) const;
  void substitute_velocity_in_form(Eigen::MatrixXd& m) const;

  Eigen::Matrix3d chart_;
  Eigen::Index nv_ = 0;
  HalfTime time_;
  Eigen::VectorXd node_;
  RotationProduct<2> turn_;
  RotationProduct<2>::Jacobian slope_;
  WorldVelocity world_;
};

/// From a node to the state after it:
///
///   w' = v + s a,   R_z' = R exp(s omega),   p_z' = p + s R v_linear,   joints_z' = joints + s rates
///
/// It does not handle variables that are carried over unchanged.
class Departure {
 public:
  void set(const Eigen::Matrix3d& chart, const Eigen::Matrix3d& next_chart, int nv, const HalfTime& time,
           const Eigen::VectorXd& node);

  void value(Eigen::Ref<Eigen::VectorXd> state) const;  ///< (z', w')
  /// Derivatives of its first six entries, the placement of the base, in the node's variables.
  void base_derivatives(Eigen::Ref<Eigen::MatrixXd> rows) const;
  /// Those of entry 6 <= i < 2 nv: of a joint's position or a velocity.
  Arrival::JointRow joint_derivatives(Eigen::Index i) const;
  /// Adds the lower triangle of the Hessian of multipliers . value().
  void add_hessian(const Eigen::VectorXd& multipliers, Eigen::MatrixXd& hessian) const;

  /// Turns a gradient in (z', w'), stored in place of q and v, into one in the node's variables. Entries of
  /// carried-over variables stay.
  void pull_back(Eigen::VectorXd& gradient) const;

 private:
  template <class Matrix>
  void substitute(Matrix&& m) const;

  Eigen::Matrix3d chart_;
  Eigen::Index nv_ = 0;
  HalfTime time_;
  Eigen::VectorXd node_;
  RotationProduct<2> turn_;
  RotationProduct<2>::Jacobian slope_;
  WorldVelocity world_;
};

}  // namespace prowl
