#include "prowl/model/limit_curve.hpp"

#include <gtest/gtest.h>

#include "prowl/error.hpp"

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

}  // namespace
}  // namespace prowl
