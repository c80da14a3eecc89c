#include "alternatives/collocation/charts/base_chart.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <numbers>

#include "alternatives/collocation/graph/rate_function.hpp"
#include "prowl/error.hpp"
#include "prowl/model/so3.hpp"
#include "tests/support/random_vector.hpp"

namespace prowl {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kStep = 1e-4;

std::vector<std::unique_ptr<BaseChart>> charts() {
  std::vector<std::unique_ptr<BaseChart>> charts;
  charts.push_back(exponential_chart(so3::exp({0.3, -0.5, 0.8})));
  charts.push_back(euler_chart());
  return charts;
}

std::vector<Vector3d> coordinates() {
  std::mt19937 rng(3);
  std::vector<Vector3d> points = {Vector3d::Zero(), {1e-9, 0.0, 0.0}};
  for (int i = 0; i < 50; ++i) points.push_back(1.3 * test::random_vector(rng, 3, 1.0));
  return points;
}

TEST(BaseChart, CoordinatesOfItsRotationsAreItsCoordinates) {
  for (const auto& chart : charts()) {
    for (const Vector3d& e : coordinates()) {
      EXPECT_LT((chart->coordinates(chart->rotation(e), e) - e).norm(), 1e-9);
    }
  }
}

TEST(BaseChart, RateAndBendAreTheDerivativesOfTheRotation) {
  std::mt19937 rng(4);
  for (const auto& chart : charts()) {
    for (const Vector3d& e : coordinates()) {
      const Vector3d u = test::random_vector(rng, 3, 1.0), lambda = test::random_vector(rng, 3, 1.0);
      const auto turned = [&](double s) -> Vector3d {
        return so3::log(chart->rotation(e).transpose() * chart->rotation(e + s * u));
      };
      const Vector3d slope =
          (8.0 * (turned(kStep) - turned(-kStep)) - (turned(2 * kStep) - turned(-2 * kStep))) / (12.0 * kStep);
      EXPECT_LT((chart->rate(e) * u - slope).norm(), 1e-9);
      const Vector3d bend = (turned(kStep) + turned(-kStep)) / (kStep * kStep);
      EXPECT_NEAR(u.dot(chart->bend(e, lambda) * u), lambda.dot(bend), 1e-5);
    }
  }
}

TEST(BaseChart, InverseRateIsTheInverse) {
  for (const auto& chart : charts()) {
    for (const Vector3d& e : coordinates()) {
      EXPECT_LT((chart->inverse_rate(e) * chart->rate(e) - Matrix3d::Identity()).norm(),
                1e-12 * (1.0 + chart->inverse_rate(e).norm()));
    }
  }
}

/// Of RateFunction, in all its inputs: that tests inverse_rate_slope and inverse_rate_curvature, too.
TEST(RateFunction, DerivativesAreThoseOfDifferences) {
  std::mt19937 rng(5);
  constexpr int kDofs = 8;
  for (const auto& chart : charts()) {
    RateFunction function(*chart, kDofs);
    for (int i = 0; i < 20; ++i) {
      const VectorXd x = test::random_vector(rng, 2 * kDofs, 1.0), weights = test::random_vector(rng, kDofs, 1.0);
      VectorXd y, unused;
      Eigen::MatrixXd dy, H, slope;
      function.evaluate_with_derivatives(x, y, dy);
      function.hessian(x, weights, H);
      for (int j = 0; j < x.size(); ++j) {
        const auto at = [&](double s) -> VectorXd {
          VectorXd value;
          function.evaluate(x + s * VectorXd::Unit(x.size(), j), value);
          return value;
        };
        EXPECT_LT((dy.col(j) - (at(kStep) - at(-kStep)) / (2 * kStep)).norm(), 1e-6);
        const auto gradient_at = [&](double s) -> VectorXd {
          function.evaluate_with_derivatives(x + s * VectorXd::Unit(x.size(), j), unused, slope);
          return slope.transpose() * weights;
        };
        EXPECT_LT((H.col(j) - (gradient_at(kStep) - gradient_at(-kStep)) / (2 * kStep)).norm(), 1e-6);
        for (int k = 0; k < kDofs; ++k) EXPECT_TRUE(dy(k, j) == 0.0 || function.depends(k, j));
        for (int k = 0; k < x.size(); ++k) EXPECT_TRUE(H(k, j) == 0.0 || function.bends(k, j));
      }
    }
  }
}

/// What happens at 90 degrees of pitch: E loses rank, so that there are angular velocities that no finite rate of the
/// angles gives, and the angles of a rotation are not unique.
TEST(EulerChart, IsSingularAtNinetyDegreesOfPitch) {
  const auto chart = euler_chart();
  const Vector3d upright(0.0, 0.5 * std::numbers::pi, 0.0);
  EXPECT_LT(std::abs(chart->rate(upright).determinant()), 1e-15);
  EXPECT_THROW(chart->coordinates(chart->rotation(upright), upright), InputError);
  double last = 0.0;
  for (const double off : {0.1, 0.01, 0.001}) {  // [rad]
    const double largest = chart->inverse_rate(upright - Vector3d(0.0, off, 0.0)).cwiseAbs().maxCoeff();
    EXPECT_NEAR(largest * off, 1.0, 0.01);
    EXPECT_GT(largest, 9.0 * last);
    last = largest;
  }
  const auto exponential = exponential_chart(Matrix3d::Identity());
  EXPECT_LT(exponential->inverse_rate(exponential->coordinates(chart->rotation(upright), Vector3d::Zero())).norm(),
            2.0);
}

}  // namespace
}  // namespace prowl
