#include "prowl/transcription/base_defects.hpp"

#include <Eigen/Geometry>

#include "prowl/model/so3.hpp"

namespace prowl {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

/// Column of each factor among the twelve arguments.
constexpr int kColumn[] = {3, 0, 6, 9};

/// Derivative of each factor with respect to its argument.
std::array<double, 4> slopes(double half) { return {-half, -1.0, 1.0, -half}; }

}  // namespace

BaseDefects::BaseDefects(const BaseState& start, const BaseState& end, double h, const Vector3d& turn)
    : half_(0.5 * h), product_(product(start, end, half_, turn)) {
  const Matrix3d R0 = start.chart * so3::exp(start.theta);
  const Matrix3d R1 = end.chart * so3::exp(end.theta);
  position_ = end.position - start.position - half_ * (R0 * start.linear_velocity + R1 * end.linear_velocity);
}

BaseDefects::Product BaseDefects::product(const BaseState& start, const BaseState& end, double half,
                                          const Vector3d& turn) {
  const Matrix3d one = Matrix3d::Identity();
  return Product({{{so3::exp(-turn), -half * start.angular_velocity},
                   {one, -start.theta},
                   {start.chart.transpose() * end.chart, end.theta},
                   {one, -half * end.angular_velocity}}});
}

BaseDefects::Matrix3x12 BaseDefects::rotation_derivative() const {
  const Product::Jacobian factors = product_.derivative();
  const std::array<double, 4> slope = slopes(half_);
  Matrix3x12 derivative;
  for (int i = 0; i < 4; ++i) derivative.middleCols<3>(kColumn[i]) = slope[i] * factors.middleCols<3>(3 * i);
  return derivative;
}

BaseDefects::Matrix12 BaseDefects::rotation_hessian(const Vector3d& lambda) const {
  const Product::Hessian factors = product_.hessian(lambda);
  const std::array<double, 4> slope = slopes(half_);
  Matrix12 hessian;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      hessian.block<3, 3>(kColumn[i], kColumn[j]) = slope[i] * slope[j] * factors.block<3, 3>(3 * i, 3 * j);
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
  // lambda . R exp(x) v = l . (v + x × v + 1/2 x × (x × v)) with l = R' lambda, plus the curvature
  // of x(theta).
  const Vector3d l = (chart * so3::exp(theta)).transpose() * lambda;
  const Matrix3d Jr = so3::right_jacobian(theta);
  const Matrix3d tangent = 0.5 * (l * v.transpose() + v * l.transpose()) - l.dot(v) * Matrix3d::Identity();
  theta_theta = Jr.transpose() * tangent * Jr + so3::right_jacobian_derivative(theta, v.cross(l));
  theta_v = -Jr.transpose() * so3::skew(l);
}

}  // namespace prowl
