#include "prowl/feasibility/friction_support.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/random_point.hpp"

namespace prowl {
namespace {

using Eigen::Vector3d;

constexpr double kDegree = std::numbers::pi / 180.0;

Surface tilted(double degrees, double friction, double heading = 0.0) {
  const double angle = degrees * kDegree, about = heading * kDegree;
  return {.normal = {-std::sin(angle) * std::cos(about), -std::sin(angle) * std::sin(about), std::cos(angle)},
          .friction = friction};
}

TEST(FrictionSupport, OnOnePlaneIsAMatterOfItsTilt) {
  EXPECT_FALSE(slide_on({tilted(15.0, 0.5)}));
  EXPECT_FALSE(slide_on({tilted(15.0, 0.27)}));
  const auto slide = slide_on({tilted(30.0, 0.5)});
  ASSERT_TRUE(slide);
  // By hand: (sin 30 - 0.5 cos 30) / sqrt(1 + 0.5²).
  EXPECT_NEAR(slide->shortfall, (0.5 - 0.25 * std::sqrt(3.0)) / std::sqrt(1.25), 1e-9);
  EXPECT_NEAR(friction_factor_needed({tilted(30.0, 0.5)}) * 0.5, std::tan(30.0 * kDegree), 1e-5);
  EXPECT_NEAR(friction_factor_needed({tilted(15.0, 0.2)}) * 0.2, 0.26795, 1e-5);
  EXPECT_EQ(friction_factor_needed({tilted(15.0, 0.5)}), 1.0);
}

TEST(FrictionSupport, OfNoSurfaceIsFreeFall) {
  const auto slide = slide_on({});
  ASSERT_TRUE(slide);
  EXPECT_EQ(slide->shortfall, 1.0);
}

TEST(FrictionSupport, OfACeilingHasNoFriction) {
  EXPECT_TRUE(slide_on({tilted(180.0, 0.5)}));
  EXPECT_TRUE(std::isinf(friction_factor_needed({tilted(180.0, 0.5)})));
}

// Too steep each, but a robot can press itself between them.
TEST(FrictionSupport, OfAGrooveIsMoreThanThatOfItsSides) {
  EXPECT_TRUE(slide_on({tilted(60.0, 0.5)}));
  EXPECT_FALSE(slide_on({tilted(60.0, 0.5), tilted(60.0, 0.5, 180.0)}));
  EXPECT_FALSE(slide_on({tilted(60.0, 0.2), tilted(60.0, 0.2, 180.0)}));
  EXPECT_TRUE(slide_on({tilted(60.0, 0.5), tilted(60.0, 0.5, 90.0)})) << "both lean the same way";
  EXPECT_FALSE(slide_on({tilted(90.0, 0.1), tilted(90.0, 0.1, 180.0)})) << "walls that face each other";
}

/// What a slide claims: no force that the cones allow together goes along it.
TEST(FrictionSupport, NeverClaimsASlideThatAForceCouldStop) {
  std::mt19937 rng(4);
  int slides = 0, holds = 0;
  for (int i = 0; i < 400; ++i) {
    std::vector<Surface> surfaces;
    for (int s = 0; s < 1 + i % 3; ++s) {
      Surface surface;
      surface.normal = test::random_vector(rng, 3, 1.0).normalized();
      surface.friction = 0.05 + 0.4 * std::abs(test::random_vector(rng, 1, 1.0)(0));
      surfaces.push_back(surface);
    }
    const auto slide = slide_on(surfaces);
    ++(slide ? slides : holds);
    if (!slide) continue;
    EXPECT_NEAR(slide->direction.norm(), 1.0, 1e-12);
    EXPECT_NEAR(slide->direction.z(), slide->shortfall, 1e-12);
    for (const Surface& surface : surfaces) {
      for (int edge = 0; edge < 360; ++edge) {
        const Vector3d tangent = surface.axes() * Eigen::Vector2d(std::cos(edge * kDegree), std::sin(edge * kDegree));
        EXPECT_LE(slide->direction.dot(surface.normal + surface.friction * tangent), 1e-9);
      }
    }
  }
  EXPECT_GT(slides, 50);
  EXPECT_GT(holds, 20);
}

}  // namespace
}  // namespace prowl
