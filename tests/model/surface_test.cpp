#include "prowl/model/surface.hpp"

#include <gtest/gtest.h>

#include "tests/support/random_point.hpp"

namespace prowl {
namespace {

using Eigen::Vector2d;

const Surface kStone{.patch = {{0.0, 0.0}, {0.4, 0.1}, {0.3, 0.5}, {-0.1, 0.3}}};

TEST(Surface, CoordinatesAndPointsAreInverse) {
  for (const Eigen::Vector3d& normal :
       {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0.2, -0.1, 1.0), Eigen::Vector3d(-1, 0, 0)}) {
    const Surface surface{.point = {0.3, -0.2, 0.1}, .normal = normal.normalized()};
    Eigen::Matrix3d frame;
    frame << surface.axes(), surface.normal;
    EXPECT_LT((frame.transpose() * frame - Eigen::Matrix3d::Identity()).norm(), 1e-14);
    EXPECT_NEAR(frame.determinant(), 1.0, 1e-14);
    const Eigen::Vector2d at(0.7, -0.4);
    const Eigen::Vector3d point = surface.at(at, 0.05);
    EXPECT_LT((surface.coordinates(point) - at).norm(), 1e-14);
    EXPECT_NEAR(surface.distance(point), 0.05, 1e-14);
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

// Two ways to one number: the distance outside is that of the nearest point, inside it is negative.
TEST(DistanceFromPatch, AgreesWithTheNearestPoint) {
  std::mt19937 rng(4);
  int outside = 0, inside = 0;
  for (int i = 0; i < 200; ++i) {
    const Vector2d p = test::random_vector(rng, 2, 0.7);
    const double distance = distance_from_patch(kStone, p);
    if (kStone.contains(p)) {
      ++inside;
      EXPECT_LE(distance, 0.0);
    } else {
      ++outside;
      EXPECT_GT(distance, 0.0);
      EXPECT_NEAR(distance, (p - nearest_in_patch(kStone, p)).norm(), 1e-15);
    }
  }
  EXPECT_GT(outside, 50);
  EXPECT_GT(inside, 5);
}

}  // namespace
}  // namespace prowl
