#include <gtest/gtest.h>

#include "prowl/model/so3.hpp"
#include "prowl/transcription/base_defects.hpp"
#include "tests/support/random_point.hpp"

namespace prowl {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

BaseState random_base(std::mt19937& rng, double theta_size) {
  const auto vector = [&](double size) -> Vector3d { return test::random_vector(rng, 3, size); };
  return {so3::exp(vector(2.0)), vector(1.0), vector(theta_size), vector(2.0), vector(2.0)};
}

TEST(BaseDefects, VanishOnTheTrapezoid) {
  std::mt19937 rng(3);
  const double h = 0.1;
  const BaseState start = random_base(rng, 0.5);
  BaseState end = random_base(rng, 0.5);
  const Eigen::Matrix3d R0 = start.chart * so3::exp(start.theta);
  const Eigen::Matrix3d R1 = R0 * so3::exp(0.5 * h * start.angular_velocity) * so3::exp(0.5 * h * end.angular_velocity);
  end.theta = so3::log(end.chart.transpose() * R1);
  end.position = start.position + 0.5 * h * (R0 * start.linear_velocity + R1 * end.linear_velocity);
  const BaseDefects defects(start, end, h);
  EXPECT_LT(defects.position().norm(), 1e-14);
  EXPECT_LT(defects.rotation().norm(), 1e-14);
  EXPECT_GT(BaseDefects(start, end, 1.1 * h).rotation().norm(), 1e-3);
}

/// The defect of the rotation with its twelve arguments moved.
Vector3d rotation_at(BaseState start, BaseState end, double h, const VectorXd& move) {
  start.theta += move.segment<3>(0);
  start.angular_velocity += move.segment<3>(3);
  end.theta += move.segment<3>(6);
  end.angular_velocity += move.segment<3>(9);
  return BaseDefects(start, end, h).rotation();
}

TEST(BaseDefects, DerivativesOfTheRotationAreThoseOfDifferences) {
  std::mt19937 rng(9);
  const double h = 0.3, step = 1e-3;
  for (const double theta_size : {0.0, 1e-5, 0.8}) {
    const BaseState start = random_base(rng, theta_size);
    BaseState end = random_base(rng, theta_size);
    end.chart = start.chart * so3::exp(test::random_vector(rng, 3, 0.5));  // defect well inside the range of log
    const Vector3d lambda = test::random_vector(rng, 3, 1.0);
    const BaseDefects defects(start, end, h);
    const auto unit = [&](int i) -> VectorXd { return step * VectorXd::Unit(12, i); };
    const auto value = [&](const VectorXd& move) { return rotation_at(start, end, h, move); };

    Eigen::MatrixXd first(3, 12), second(12, 12);
    for (int i = 0; i < 12; ++i) {
      first.col(i) =
          (8.0 * (value(unit(i)) - value(-unit(i))) - (value(2 * unit(i)) - value(-2 * unit(i)))) / (12 * step);
      for (int j = 0; j < 12; ++j) {
        const auto at = [&](double s) {
          const VectorXd plus = s * (unit(i) + unit(j)), minus = s * (unit(i) - unit(j));
          return lambda.dot(value(plus) - value(minus) - value(-minus) + value(-plus)) / (4 * s * s * step * step);
        };
        second(i, j) = (4.0 * at(1.0) - at(2.0)) / 3.0;
      }
    }
    EXPECT_LT(test::relative_error(defects.rotation_derivative(), first), 1e-9);
    EXPECT_LT(test::relative_error(defects.rotation_hessian(lambda), second), 1e-6);
  }
}

TEST(WorldVelocity, DerivativesAreThoseOfDifferences) {
  std::mt19937 rng(4);
  const BaseState base = random_base(rng, 0.7);
  const Vector3d lambda = test::random_vector(rng, 3, 1.0);
  const WorldVelocity at(base.chart, base.theta, base.linear_velocity);
  const WorldVelocityHessian hessian(base.chart, base.theta, base.linear_velocity, lambda);
  const double step = 1e-5;
  for (int i = 0; i < 3; ++i) {
    const Vector3d move = step * Vector3d::Unit(i);
    const WorldVelocity turned(base.chart, base.theta + move, base.linear_velocity);
    const WorldVelocity back(base.chart, base.theta - move, base.linear_velocity);
    EXPECT_LT(test::relative_error(at.d_theta.col(i), (turned.value - back.value) / (2 * step)), 1e-8);
    const Vector3d theta_theta = (turned.d_theta - back.d_theta).transpose() * lambda / (2 * step);
    const Vector3d v_theta = (turned.d_v - back.d_v).transpose() * lambda / (2 * step);
    EXPECT_LT(test::relative_error(hessian.theta_theta.col(i), theta_theta), 1e-8);
    EXPECT_LT(test::relative_error(hessian.theta_v.row(i).transpose(), v_theta), 1e-8);
  }
}

}  // namespace
}  // namespace prowl
