#pragma once

#include <Eigen/Core>

#include "prowl/transcription/rotation_product.hpp"

namespace prowl {

/// Base state at one end of a mesh interval: R = chart exp(theta), position p in the world [m],
/// velocities in the base frame [m/s, rad/s].
struct BaseState {
  Eigen::Matrix3d chart;
  Eigen::Vector3d position, theta, linear_velocity, angular_velocity;
};

/// Defects of the trapezoid over one interval of length h [s], for world position and rotation of
/// the base:
///
///   d_p = p1 - p0 - h/2 (R0 v0 + R1 v1)
///   d_R = log( (R0 exp(h/2 w0))' R1 exp(-h/2 w1) )
///
/// The rule is symmetric in time, hence of second order as on a vector space. (Joints and v have
/// linear defects, see IntervalDefects.)
class BaseDefects {
 public:
  /// Order of the twelve arguments: theta0, w0, theta1, w1.
  using Matrix3x12 = Eigen::Matrix<double, 3, 12>;
  using Matrix12 = Eigen::Matrix<double, 12, 12>;

  BaseDefects(const BaseState& start, const BaseState& end, double h,
              const Eigen::Vector3d& turn = Eigen::Vector3d::Zero());

  const Eigen::Vector3d& position() const { return position_; }
  const Eigen::Vector3d& rotation() const { return product_.value(); }

  /// d(d_R)/d(theta0, w0, theta1, w1).
  Matrix3x12 rotation_derivative() const;
  /// Hessian of lambda . d_R in the same arguments.
  Matrix12 rotation_hessian(const Eigen::Vector3d& lambda) const;

 private:
  using Product = RotationProduct<4>;
  static Product product(const BaseState& start, const BaseState& end, double half, const Eigen::Vector3d& turn);

  double half_;
  Eigen::Vector3d position_;
  Product product_;  ///< of exp(-h/2 w0) exp(-theta0) (charts) exp(theta1) exp(-h/2 w1)
};

/// World velocity R v of the base, R = chart exp(theta), with its derivatives in (theta, v).
struct WorldVelocity {
  Eigen::Vector3d value;
  Eigen::Matrix3d d_theta, d_v;
  WorldVelocity() = default;
  WorldVelocity(const Eigen::Matrix3d& chart, const Eigen::Vector3d& theta, const Eigen::Vector3d& v);
};
/// Second derivatives of lambda . R v.
struct WorldVelocityHessian {
  Eigen::Matrix3d theta_theta, theta_v;
  WorldVelocityHessian(const Eigen::Matrix3d& chart, const Eigen::Vector3d& theta, const Eigen::Vector3d& v,
                       const Eigen::Vector3d& lambda);
};

}  // namespace prowl
