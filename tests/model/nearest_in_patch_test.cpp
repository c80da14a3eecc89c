#include "prowl/model/nearest_in_patch.hpp"

#include <gtest/gtest.h>

#include "tests/support/random_point.hpp"

namespace prowl {
namespace {

using Eigen::Vector2d;

const Surface kStone{.patch = {{0.0, 0.0}, {0.4, 0.1}, {0.3, 0.5}, {-0.1, 0.3}}};

TEST(NearestInPatch, IsThePointItselfInside) {
  EXPECT_EQ(nearest_in_patch(kStone, {0.1, 0.2}), Vector2d(0.1, 0.2));
  EXPECT_EQ(nearest_in_patch(Surface{}, {7.0, -8.0}), Vector2d(7.0, -8.0)) << "a plane has no edge";
}

TEST(NearestInPatch, IsNearerThanAnyOtherPointOfThePatch) {
  std::mt19937 rng(3);
  for (int i = 0; i < 100; ++i) {
    const Vector2d p = test::random_vector(rng, 2, 1.0);
    const Vector2d nearest = nearest_in_patch(kStone, p);
    // The corners are affinely dependent, but their convex combinations are all of the patch.
    for (int j = 0; j < 100; ++j) {
      const Eigen::Vector4d weights = test::random_vector(rng, 4, 1.0).cwiseAbs();
      Vector2d other = Vector2d::Zero();
      for (int c = 0; c < 4; ++c) other += weights(c) / weights.sum() * kStone.patch[c];
      EXPECT_LE((nearest - p).norm(), (other - p).norm() + 1e-12);
    }
  }
}

}  // namespace
}  // namespace prowl
