#include "prowl/model/limit_curve.hpp"

#include <gtest/gtest.h>

#include "prowl/error.hpp"
#include "prowl/model/surface.hpp"

namespace prowl {
namespace {

const LimitCurve::Table kTable = {{-2.4, 60.0}, {-1.8, 120.0}, {-1.2, 145.0}, {-0.6, 130.0}, {-0.3, 100.0}};

TEST(LimitCurve, GoesThroughItsPoints) {
  const LimitCurve curve(kTable);
  for (const auto& [x, limit] : kTable) EXPECT_NEAR(curve.value(x), limit, 1e-11);
  EXPECT_EQ(curve.largest(), 145.0);
}

// scripts/plot_knee draws the same curve; tests/scripts/plot_knee_test.py has the same numbers.
TEST(LimitCurve, IsTheSplineWithAveragedKnots) {
  const LimitCurve curve({{0.0, 50.0}, {0.5, 80.0}, {1.0, 90.0}, {1.5, 70.0}, {2.0, 40.0}});
  EXPECT_NEAR(curve.value(0.2), 63.28, 1e-9);
  EXPECT_NEAR(curve.value(0.7), 87.38, 1e-9);
  EXPECT_NEAR(curve.value(1.3), 80.74, 1e-9);
  EXPECT_NEAR(curve.value(1.9), 45.48, 1e-9);
}

TEST(LimitCurve, DerivativesAreThoseOfDifferences) {
  const LimitCurve curve(kTable);
  for (const double x : {-2.39, -1.8, -1.5, -0.9, -0.31, -2.6, 0.4}) {  // the last two beyond the table
    const double h = 1e-5;
    EXPECT_NEAR(curve.slope(x), (curve.value(x + h) - curve.value(x - h)) / (2 * h), 1e-6) << x;
    EXPECT_NEAR(curve.curvature(x), (curve.slope(x + h) - curve.slope(x - h)) / (2 * h), 1e-4) << x;
  }
}

TEST(LimitCurve, RefusesTablesThatAreNone) {
  EXPECT_THROW(LimitCurve({{0.0, 1.0}, {1.0, 1.0}, {2.0, 1.0}}), InputError) << "too few";
  EXPECT_THROW(LimitCurve({{0.0, 1.0}, {2.0, 1.0}, {1.0, 1.0}, {3.0, 1.0}}), InputError) << "out of order";
  EXPECT_THROW(LimitCurve({{0.0, 1.0}, {1.0, 0.0}, {2.0, 1.0}, {3.0, 1.0}}), InputError) << "a limit of zero";
  EXPECT_THROW(LimitCurve({{0.0, 100.0}, {1.0, 1.0}, {2.0, 1.0}, {3.0, 100.0}}), InputError) << "below zero in between";
}

TEST(Surface, CoordinatesAndPlacesAreInverse) {
  for (const Eigen::Vector3d& normal :
       {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0.2, -0.1, 1.0), Eigen::Vector3d(-1, 0, 0)}) {
    const Surface surface{.point = {0.3, -0.2, 0.1}, .normal = normal.normalized()};
    Eigen::Matrix3d frame;
    frame << surface.axes(), surface.normal;
    EXPECT_LT((frame.transpose() * frame - Eigen::Matrix3d::Identity()).norm(), 1e-14);
    EXPECT_NEAR(frame.determinant(), 1.0, 1e-14);
    const Eigen::Vector2d at(0.7, -0.4);
    const Eigen::Vector3d place = surface.at(at, 0.05);
    EXPECT_LT((surface.coordinates(place) - at).norm(), 1e-14);
    EXPECT_NEAR(surface.distance(place), 0.05, 1e-14);
  }
}

TEST(Surface, APatchContainsWhatIsInsideItsEdges) {
  const Surface square{.patch = {{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}}};
  EXPECT_TRUE(square.contains({0.5, 0.5}));
  EXPECT_TRUE(square.contains({1.0, 0.2}));
  EXPECT_FALSE(square.contains({1.1, 0.5}));
  EXPECT_TRUE(Surface{}.contains({100.0, 0.0}));
  EXPECT_EQ(Surface::patch_fault(square.patch), "");
  EXPECT_NE(Surface::patch_fault({{0.0, 0.0}, {1.0, 0.0}, {0.2, 0.2}, {0.0, 1.0}}), "") << "not convex";
}

}  // namespace
}  // namespace prowl
