#include "prowl/motion/friction_cone.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "tests/support/random_point.hpp"

namespace prowl {
namespace {

using Eigen::Vector3d;

std::vector<FrictionCone> cones() {
  return {{Vector3d::UnitZ(), 0.5, 1.0}, {Vector3d(0.3, -0.4, 1.0).normalized(), 0.8, 0.05}};
}

/// Forces around the cones, the awkward ones included: zero, along the normal, pulling.
std::vector<Vector3d> forces() {
  std::vector<Vector3d> result{Vector3d::Zero(), Vector3d(0, 0, 100), Vector3d(0, 0, -100), Vector3d(50, 0, 100)};
  std::mt19937 rng(8);
  for (int i = 0; i < 500; ++i) result.emplace_back(test::random_vector(rng, 3, 100.0));
  return result;
}

TEST(FrictionCone, AcceptsOnlyForcesInsideTheExactCone) {
  for (const FrictionCone& cone : cones()) {
    int accepted = 0;
    for (const Vector3d& force : forces()) {
      if (cone.value(force) < 0.0) continue;
      ++accepted;
      const double normal = cone.normal.dot(force);
      EXPECT_LT((force - normal * cone.normal).norm(), cone.mu * normal);
    }
    EXPECT_GT(accepted, 10) << "the samples never enter the cone, so the test checks nothing";
  }
}

TEST(FrictionCone, LosesNoMoreThanItsSmoothing) {
  for (const FrictionCone& cone : cones()) {
    for (const Vector3d& force : forces()) {
      const double normal = cone.normal.dot(force);
      const double exact = cone.mu * normal - (force - normal * cone.normal).norm();
      EXPECT_LE(exact - cone.value(force), cone.smoothing + 1e-12);
    }
  }
}

TEST(FrictionCone, ConeOfATiltedSurfaceIsTheConeOfTheFloorTilted) {
  const FrictionCone floor = cones()[0];
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), Vector3d(0.26, 0.0, 0.97));
  const FrictionCone slope{turn * floor.normal, floor.mu, floor.smoothing};
  for (const Vector3d& force : forces()) EXPECT_NEAR(slope.value(turn * force), floor.value(force), 1e-10);
}

// By hand: 100 N straight up on a slope of 15 degrees are 96.59 N along its normal and 25.88 N along the slope.
TEST(FrictionCone, OfAForceStraightUpOnASlopeIsTheOneOfTheTiltedNormal) {
  const Vector3d normal(-0.2588190451, 0.0, 0.9659258263), up(0.0, 0.0, 100.0);
  EXPECT_NEAR((FrictionCone{normal, 0.5, 1e-6}).value(up), 22.4144, 1e-3);
  EXPECT_NEAR((FrictionCone{normal, 0.26, 1e-6}).value(up), -0.7678, 1e-3);
}

TEST(FrictionCone, DerivativesAreThoseOfDifferences) {
  const double step = 1e-4;
  for (const FrictionCone& cone : cones()) {
    for (const Vector3d& force : forces()) {
      for (int i = 0; i < 3; ++i) {
        const Vector3d move = step * Vector3d::Unit(i);
        EXPECT_NEAR(cone.gradient(force)(i), (cone.value(force + move) - cone.value(force - move)) / (2 * step), 1e-5);
        const Vector3d change = (cone.gradient(force + move) - cone.gradient(force - move)) / (2 * step);
        EXPECT_LT((cone.hessian(force).col(i) - change).norm(), 1e-3 * (1.0 + change.norm()));
      }
    }
  }
}

}  // namespace
}  // namespace prowl
