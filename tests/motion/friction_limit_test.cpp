#include "prowl/motion/friction_limit.hpp"

#include <gtest/gtest.h>

#include "tests/support/random_point.hpp"

namespace prowl {
namespace {

using Eigen::Vector3d;

const Surface kSlope{.name = "slope", .normal = Vector3d(0.3, -0.4, 1.0).normalized(), .friction = 0.6};

std::vector<Vector3d> forces() {
  std::vector<Vector3d> result{Vector3d::Zero()};
  std::mt19937 rng(8);
  for (int i = 0; i < 2000; ++i) result.emplace_back(test::random_vector(rng, 3, 100.0));
  return result;
}

TEST(FrictionLimit, ConeIsTheOneRowOfFrictionCone) {
  const FrictionLimit limit(FrictionModel::cone, kSlope, 2.0);
  const FrictionCone cone{kSlope.normal, kSlope.friction, 2.0};
  ASSERT_EQ(limit.count(), 1);
  for (const Vector3d& force : forces()) {
    EXPECT_EQ(limit.rows(force)(0), cone.value(force));
    EXPECT_EQ(limit.slopes(force).transpose(), cone.gradient(force));
    EXPECT_EQ(limit.curvature(force, Eigen::VectorXd::Constant(1, 3.0)), 3.0 * cone.hessian(force));
  }
}

TEST(FrictionLimit, PyramidIsInsideTheConeAndTouchesIt) {
  const FrictionLimit limit(FrictionModel::pyramid, kSlope, 2.0);
  ASSERT_EQ(limit.count(), 4);
  int accepted = 0;
  for (const Vector3d& force : forces()) {
    const double normal = kSlope.normal.dot(force), tangential = (force - normal * kSlope.normal).norm();
    if (limit.rows(force).minCoeff() >= 0.0) {
      ++accepted;
      EXPECT_GE(normal, 0.0);
      EXPECT_LE(tangential, kSlope.friction * normal * (1.0 + 1e-12));
    } else {  // it leaves out no more than its 29 %
      EXPECT_GT(tangential, kSlope.friction / std::sqrt(2.0) * normal);
    }
  }
  EXPECT_GT(accepted, 50) << "the samples never enter the pyramid, so the test checks nothing";
  const Vector3d corner =
      kSlope.normal + kSlope.friction * (kSlope.axes().col(0) + kSlope.axes().col(1)) / std::sqrt(2.0);
  EXPECT_NEAR(limit.rows(corner).minCoeff(), 0.0, 1e-15);
}

/// With a least load its tip is there, and no wider.
TEST(FrictionLimit, PyramidAsksForTheLeastLoad) {
  constexpr double kLeast = 10.0;
  const FrictionLimit limit(FrictionModel::pyramid, kSlope, 2.0, kLeast), free(FrictionModel::pyramid, kSlope, 2.0);
  int accepted = 0;
  for (const Vector3d& force : forces()) {
    EXPECT_LT((limit.rows(force) - free.rows(force - kLeast * kSlope.normal)).norm(), 1e-12);
    if (limit.rows(force).minCoeff() < 0.0) continue;
    ++accepted;
    EXPECT_GE(kSlope.normal.dot(force), kLeast);
  }
  EXPECT_GT(accepted, 50);
}

TEST(FrictionLimit, PyramidIsLinear) {
  const FrictionLimit limit(FrictionModel::pyramid, kSlope, 2.0);
  for (const Vector3d& force : forces()) {
    EXPECT_LT((limit.rows(force) - limit.slopes(force) * force).norm(), 1e-12);
    EXPECT_EQ(limit.curvature(force, Eigen::VectorXd::Ones(4)), Eigen::Matrix3d::Zero());
  }
}

}  // namespace
}  // namespace prowl
