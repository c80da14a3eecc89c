#include "prowl/terms/angle_ratio.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace prowl {
namespace {

TEST(AngleRatio, IsTheAngleOverItsSine) {
  for (const double angle : {1e-8, 1e-4, 0.01, 0.2, 0.24, 0.25, 0.3, 1.0, 2.0, 3.0}) {
    EXPECT_NEAR(AngleRatio(std::cos(angle)).value, angle / std::sin(angle), 1e-12 * angle / std::sin(angle)) << angle;
  }
  EXPECT_EQ(AngleRatio(1.0).value, 1.0);
}

TEST(AngleRatio, DerivativesAreThoseOfDifferences) {
  for (const double x : {1.0, 0.999, 0.975, 0.97, 0.965, 0.5, 0.0, -0.7}) {
    const double h = 1e-5;
    const AngleRatio at(x), above(x + h), below(x - h);
    EXPECT_NEAR(at.slope, (above.value - below.value) / (2.0 * h), 1e-8) << x;
    EXPECT_NEAR(at.curvature, (above.slope - below.slope) / (2.0 * h), 1e-7) << x;
  }
}

}  // namespace
}  // namespace prowl
