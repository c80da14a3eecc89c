#include "prowl/model/so3.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>
#include <random>
#include <vector>

namespace prowl {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Vector3d random_direction(std::mt19937& rng) {
  std::normal_distribution<double> normal;
  return Vector3d(normal(rng), normal(rng), normal(rng)).normalized();
}

/// Rotation vectors of the awkward lengths: zero, almost zero, where the series ends (1), and almost pi.
std::vector<Vector3d> rotation_vectors() {
  std::mt19937 rng(1);
  std::vector<Vector3d> result;
  for (const double angle : {0.0, 1e-9, 1e-4, 0.1, 0.999999, 1.0, 1.000001, 2.0, 3.0, 3.14159}) {
    for (int i = 0; i < 5; ++i) result.push_back(angle * random_direction(rng));
  }
  return result;
}

TEST(So3, ExpIsTheSeriesOfMatrixPowers) {
  for (const Vector3d& theta : rotation_vectors()) {
    Matrix3d sum = Matrix3d::Identity(), term = Matrix3d::Identity();
    for (int k = 1; k < 40; ++k) sum += term = (term * so3::skew(theta) / k).eval();
    EXPECT_LT((so3::exp(theta) - sum).norm(), 1e-14 * 10) << theta.transpose();
  }
}

TEST(So3, LogIsTheInverseOfExpUpToPi) {
  for (const Vector3d& theta : rotation_vectors()) {
    EXPECT_LT((so3::log(so3::exp(theta)) - theta).norm(), 1e-12) << theta.transpose();
  }
  const Matrix3d half_turn = so3::exp(Vector3d(0.0, std::numbers::pi, 0.0));
  EXPECT_NEAR(so3::log(half_turn).norm(), std::numbers::pi, 1e-12);
}

TEST(So3, ShortestRotationTurnsFromOneDirectionToTheOther) {
  std::mt19937 rng(2);
  for (const double angle : {0.0, 1e-9, 0.3, 2.0, 3.0, 3.1415926, std::numbers::pi}) {
    const Vector3d from = random_direction(rng), axis = from.unitOrthogonal();
    const Vector3d to = so3::exp(angle * axis) * from;
    const Matrix3d R = so3::shortest_rotation(2.0 * from, 0.5 * to);
    EXPECT_LT((R * from - to).norm(), 1e-12) << angle;
    EXPECT_LT((R.transpose() * R - Matrix3d::Identity()).norm(), 1e-12) << angle;
    EXPECT_NEAR(so3::log(R).norm(), angle, 1e-7) << angle;
  }
}

TEST(So3, RightJacobianIsTheDerivativeOfExp) {
  const double step = 1e-6;
  for (const Vector3d& theta : rotation_vectors()) {
    Matrix3d differences;
    for (int i = 0; i < 3; ++i) {
      const Vector3d d = step * Vector3d::Unit(i);
      differences.col(i) = so3::log(so3::exp(theta - d).transpose() * so3::exp(theta + d)) / (2.0 * step);
    }
    EXPECT_LT((so3::right_jacobian(theta) - differences).norm(), 1e-9) << theta.transpose();
  }
}

TEST(So3, RightJacobianTimesItsInverseIsTheIdentity) {
  for (const Vector3d& theta : rotation_vectors()) {
    const Matrix3d product = so3::right_jacobian(theta) * so3::right_jacobian_inverse(theta);
    EXPECT_LT((product - Matrix3d::Identity()).norm(), 1e-13) << theta.transpose();
  }
}

TEST(So3, DerivativeOfTheRightJacobianAgreesWithDifferences) {
  const double step = 1e-5;
  std::mt19937 rng(2);
  double largest = 0.0;
  for (const Vector3d& theta : rotation_vectors()) {
    const Vector3d lambda = random_direction(rng);
    const Matrix3d B = so3::right_jacobian_derivative(theta, lambda);
    EXPECT_EQ(B, B.transpose().eval());
    largest = std::max(largest, B.norm());
    for (int i = 0; i < 5; ++i) {
      const Vector3d u = random_direction(rng);
      const Vector3d change = (so3::right_jacobian(theta + step * u) - so3::right_jacobian(theta - step * u)) * u;
      EXPECT_NEAR(u.dot(B * u), lambda.dot(change) / (2.0 * step), 2e-10) << theta.transpose();
    }
  }
  EXPECT_GT(largest, 0.1) << "the derivatives vanish, so the test checks nothing";
}

TEST(So3, SecondDerivativeOfLogFollowsFromIt) {
  const double step = 1e-4;
  std::mt19937 rng(3);
  for (const Vector3d& theta : rotation_vectors()) {
    if (theta.norm() > 2.5) continue;  // keeps the differences away from pi, where log jumps
    const Vector3d lambda = random_direction(rng), w = random_direction(rng);
    const Matrix3d inverse = so3::right_jacobian_inverse(theta);
    const Vector3d rate = inverse * w;
    const double second = -rate.dot(so3::right_jacobian_derivative(theta, inverse.transpose() * lambda) * rate);
    const auto phi = [&](double s) { return lambda.dot(so3::log(so3::exp(theta) * so3::exp(s * w))); };
    EXPECT_NEAR(second, (phi(step) - 2.0 * phi(0.0) + phi(-step)) / (step * step), 3e-7) << theta.transpose();
  }
}

}  // namespace
}  // namespace prowl
