#include "alternatives/collocation/graph/rate_function.hpp"

#include <Eigen/Geometry>

#include "prowl/model/so3.hpp"

namespace prowl {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

bool RateFunction::depends(int i, int j) const {
  const bool on_rotation = j >= 3 && j < 6;
  if (i < 3) return on_rotation || (j >= nv_ && j < nv_ + 3);
  if (i < 6) return on_rotation || (j >= nv_ + 3 && j < nv_ + 6);
  return j == nv_ + i;
}

bool RateFunction::bends(int i, int j) const {
  const auto is_rotation = [](int k) { return k >= 3 && k < 6; };
  const auto is_twist = [this](int k) { return k >= nv_ && k < nv_ + 6; };
  return (is_rotation(i) && (is_rotation(j) || is_twist(j))) || (is_twist(i) && is_rotation(j));
}

void RateFunction::evaluate(const VectorXd& x, VectorXd& y) {
  const Vector3d e = x.segment<3>(3), v = x.segment<3>(nv_), w = x.segment<3>(nv_ + 3);
  y.resize(nv_);
  y << chart_.rotation(e) * v, chart_.inverse_rate(e) * w, x.tail(nv_ - 6);
}

void RateFunction::evaluate_with_derivatives(const VectorXd& x, VectorXd& y, MatrixXd& dy) {
  evaluate(x, y);
  const Vector3d e = x.segment<3>(3), v = x.segment<3>(nv_), w = x.segment<3>(nv_ + 3);
  const Matrix3d R = chart_.rotation(e);
  dy.setZero(nv_, 2 * nv_);
  dy.block<3, 3>(0, 3) = -R * so3::skew(v) * chart_.rate(e);
  dy.block<3, 3>(0, nv_) = R;
  dy.block<3, 3>(3, 3) = chart_.inverse_rate_slope(e, w);
  dy.block<3, 3>(3, nv_ + 3) = chart_.inverse_rate(e);
  dy.rightCols(nv_ - 6).bottomRows(nv_ - 6).setIdentity();
}

void RateFunction::hessian(const VectorXd& x, const VectorXd& weights, MatrixXd& result) {
  const Vector3d e = x.segment<3>(3), v = x.segment<3>(nv_), w = x.segment<3>(nv_ + 3);
  const Vector3d on_e = weights.segment<3>(3);
  const Vector3d pulled = chart_.rotation(e).transpose() * weights.head<3>();
  const Matrix3d E = chart_.rate(e);
  result.setZero(2 * nv_, 2 * nv_);

  // λ · R exp(θ) v = pulled · (v + θ × v + 1/2 θ × (θ × v)), then θ in e.
  const Matrix3d outer = 0.5 * (pulled * v.transpose() + v * pulled.transpose());
  const Matrix3d in_theta = outer - pulled.dot(v) * Matrix3d::Identity();
  result.block<3, 3>(3, 3) =
      E.transpose() * in_theta * E + chart_.bend(e, v.cross(pulled)) + chart_.inverse_rate_curvature(e, w, on_e);
  // pulled · (θ × v) = θ · (v × pulled)
  result.block<3, 3>(3, nv_) = -E.transpose() * so3::skew(pulled);
  for (int i = 0; i < 3; ++i) {
    result.block<3, 1>(3, nv_ + 3 + i) = chart_.inverse_rate_slope(e, Vector3d::Unit(i)).transpose() * on_e;
  }
  result.block<6, 3>(nv_, 3) = result.block<3, 6>(3, nv_).transpose();
}

}  // namespace prowl
