#pragma once

#include <Eigen/Core>
#include <array>

#include "prowl/model/so3.hpp"

namespace prowl {

/// Rotation vector of a product of rotations,  log( B1 exp(x1) B2 exp(x2) ... BN exp(xN) ),  with its derivatives in
/// (x1 ... xN).
template <int N>
class RotationProduct {
 public:
  struct Factor {
    Eigen::Matrix3d before;  ///< B, fixed
    Eigen::Vector3d x;
  };
  using Jacobian = Eigen::Matrix<double, 3, 3 * N>;
  using Hessian = Eigen::Matrix<double, 3 * N, 3 * N>;

  RotationProduct() = default;
  explicit RotationProduct(const std::array<Factor, N>& factors) : factors_(factors) {
    Eigen::Matrix3d product = Eigen::Matrix3d::Identity();
    for (int i = N - 1; i >= 0; --i) {
      after_[i] = product;
      product = factors_[i].before * so3::exp(factors_[i].x) * product;
    }
    value_ = so3::log(product);
    log_derivative_ = so3::right_jacobian_inverse(value_);
    // A change of factor i, moved behind all later factors, is a right perturbation of the product.
    for (int i = 0; i < N; ++i) moved_[i] = after_[i].transpose() * so3::right_jacobian(factors_[i].x);
  }

  const Eigen::Vector3d& value() const { return value_; }

  Jacobian derivative() const {
    Jacobian result;
    for (int i = 0; i < N; ++i) result.template middleCols<3>(3 * i) = log_derivative_ * moved_[i];
    return result;
  }

  /// Second derivative of lambda . value().
  Hessian hessian(const Eigen::Vector3d& lambda) const {
    // log(M exp(y1) ... exp(yN)) to second order: the y_i add up to y + 1/2 sum_{i<j} y_i x y_j
    // (Baker-Campbell-Hausdorff), each y_i has its own second-order part, and log contributes minus
    // the derivative of Jr.
    const Eigen::Vector3d pulled = log_derivative_.transpose() * lambda;
    const Eigen::Matrix3d pulled_cross = so3::skew(pulled);
    const Jacobian slope = derivative();
    Hessian result = -slope.transpose() * so3::right_jacobian_derivative(value_, pulled) * slope;
    for (int i = 0; i < N; ++i) {
      result.template block<3, 3>(3 * i, 3 * i) += so3::right_jacobian_derivative(factors_[i].x, after_[i] * pulled);
      for (int j = i + 1; j < N; ++j) {
        const Eigen::Matrix3d block = -0.5 * moved_[i].transpose() * pulled_cross * moved_[j];
        result.template block<3, 3>(3 * i, 3 * j) += block;
        result.template block<3, 3>(3 * j, 3 * i) += block.transpose();
      }
    }
    return result;
  }

 private:
  std::array<Factor, N> factors_;
  Eigen::Matrix3d after_[N];  ///< product of all factors after each
  Eigen::Matrix3d moved_[N];
  Eigen::Vector3d value_;
  Eigen::Matrix3d log_derivative_;  ///< Jr^-1(value)
};

}  // namespace prowl
