#include "prowl/transcription/defects.hpp"

#include <Eigen/Geometry>

#include "prowl/model/so3.hpp"

namespace prowl {

using Eigen::Matrix3d;
using Eigen::Vector3d;

BaseDefects::BaseDefects(const BaseState& start, const BaseState& end, double h) {
  const double half = 0.5 * h;
  const Matrix3d R0 = start.chart * so3::exp(start.theta);
  const Matrix3d R1 = end.chart * so3::exp(end.theta);
  position_ = end.position - start.position - half * (R0 * start.linear_velocity + R1 * end.linear_velocity);

  factors_[0] = {-half * start.angular_velocity, -half, Matrix3d::Identity(), 3};
  factors_[1] = {-start.theta, -1.0, Matrix3d::Identity(), 0};
  factors_[2] = {end.theta, 1.0, Matrix3d::Identity(), 6};
  factors_[3] = {-half * end.angular_velocity, -half, Matrix3d::Identity(), 9};
  const Matrix3d charts = start.chart.transpose() * end.chart;
  factors_[2].after = so3::exp(factors_[3].x);
  factors_[1].after = charts * so3::exp(factors_[2].x) * factors_[2].after;
  factors_[0].after = so3::exp(factors_[1].x) * factors_[1].after;
  rotation_ = so3::log(so3::exp(factors_[0].x) * factors_[0].after);
  log_derivative_ = so3::right_jacobian_inverse(rotation_);
}

BaseDefects::Matrix3x12 BaseDefects::rotation_derivative() const {
  // A change of factor i, moved behind all factors after it, is a right perturbation of the product.
  Matrix3x12 derivative;
  for (const Factor& factor : factors_) {
    derivative.middleCols<3>(factor.column) =
        factor.slope * log_derivative_ * factor.after.transpose() * so3::right_jacobian(factor.x);
  }
  return derivative;
}

BaseDefects::Matrix12 BaseDefects::rotation_hessian(const Vector3d& lambda) const {
  // log(M exp(y1) ... exp(y4)) to second order: the y_i add up to y + 1/2 sum_{i<j} y_i x y_j (Baker-Campbell-Hausdorff),
  // each y_i has a second-order part of its own, and log bends with minus the derivative of Jr.
  const Vector3d pulled = log_derivative_.transpose() * lambda;
  const Matrix3d pulled_cross = so3::skew(pulled);
  const Matrix3x12 w = rotation_derivative();
  Matrix12 hessian = -w.transpose() * so3::right_jacobian_derivative(rotation_, pulled) * w;
  Matrix3d y[4];
  for (int i = 0; i < 4; ++i) {
    const Factor& factor = factors_[i];
    y[i] = factor.slope * factor.after.transpose() * so3::right_jacobian(factor.x);
    hessian.block<3, 3>(factor.column, factor.column) +=
        factor.slope * factor.slope * so3::right_jacobian_derivative(factor.x, factor.after * pulled);
  }
  for (int i = 0; i < 4; ++i) {
    for (int j = i + 1; j < 4; ++j) {
      const Matrix3d block = -0.5 * y[i].transpose() * pulled_cross * y[j];
      hessian.block<3, 3>(factors_[i].column, factors_[j].column) += block;
      hessian.block<3, 3>(factors_[j].column, factors_[i].column) += block.transpose();
    }
  }
  return hessian;
}

WorldVelocity::WorldVelocity(const Matrix3d& chart, const Vector3d& theta, const Vector3d& v)
    : d_v(chart * so3::exp(theta)) {
  value = d_v * v;
  d_theta = -d_v * so3::skew(v) * so3::right_jacobian(theta);
}

WorldVelocityHessian::WorldVelocityHessian(const Matrix3d& chart, const Vector3d& theta, const Vector3d& v,
                                           const Vector3d& lambda) {
  // lambda . R exp(x) v = l . (v + x × v + 1/2 x × (x × v)) with l = R' lambda; then x(theta) is curved too.
  const Vector3d l = (chart * so3::exp(theta)).transpose() * lambda;
  const Matrix3d Jr = so3::right_jacobian(theta);
  const Matrix3d tangent =
      0.5 * (l * v.transpose() + v * l.transpose()) - l.dot(v) * Matrix3d::Identity();
  theta_theta = Jr.transpose() * tangent * Jr + so3::right_jacobian_derivative(theta, v.cross(l));
  theta_v = -Jr.transpose() * so3::skew(l);
}

}  // namespace prowl
