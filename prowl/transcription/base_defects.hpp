#pragma once

#include <Eigen/Core>

#include "prowl/transcription/rotation_product.hpp"

namespace prowl {

/// The base at one end of a mesh interval: R = chart exp(theta), world position p, velocity in the base frame.
struct BaseState {
  Eigen::Matrix3d chart;
  Eigen::Vector3d position, theta, linear_velocity, angular_velocity;
};

/// Trapezoid of the base over one interval of length h, for its position in the world and its rotation:
///
///   d_p = p1 - p0 - h/2 (R0 v0 + R1 v1)
///   d_R = log( (R0 exp(h/2 w0))' R1 exp(-h/2 w1) )
///
/// Both vanish for the motion of the trapezoid. It is symmetric in time, so it is of second order as on a vector space.
/// (The joints and v are vectors: their defects are linear and need no code of their own.)
class BaseDefects {
 public:
  /// Order of the twelve arguments that rotate: theta0, w0, theta1, w1.
  using Matrix3x12 = Eigen::Matrix<double, 3, 12>;
  using Matrix12 = Eigen::Matrix<double, 12, 12>;

  BaseDefects(const BaseState& start, const BaseState& end, double h);

  const Eigen::Vector3d& position() const { return position_; }
  const Eigen::Vector3d& rotation() const { return product_.value(); }

  /// d(d_R)/d(theta0, w0, theta1, w1).
  Matrix3x12 rotation_derivative() const;
  /// Second derivative of lambda . d_R in the same arguments.
  Matrix12 rotation_hessian(const Eigen::Vector3d& lambda) const;

 private:
  using Product = RotationProduct<4>;
  static Product product(const BaseState& start, const BaseState& end, double half);

  double half_;
  Eigen::Vector3d position_;
  Product product_;  ///< of exp(-h/2 w0) exp(-theta0) (charts) exp(theta1) exp(-h/2 w1)
};

/// World velocity R v of the base with R = chart exp(theta), its derivatives in (theta, v) and the second derivatives
/// of lambda . R v.
struct WorldVelocity {
  Eigen::Vector3d value;
  Eigen::Matrix3d d_theta, d_v;
  WorldVelocity() = default;
  WorldVelocity(const Eigen::Matrix3d& chart, const Eigen::Vector3d& theta, const Eigen::Vector3d& v);
};
struct WorldVelocityHessian {
  Eigen::Matrix3d theta_theta, theta_v;
  WorldVelocityHessian(const Eigen::Matrix3d& chart, const Eigen::Vector3d& theta, const Eigen::Vector3d& v,
                       const Eigen::Vector3d& lambda);
};

}  // namespace prowl
