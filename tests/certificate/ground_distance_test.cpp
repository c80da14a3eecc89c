#include "prowl/certificate/ground_distance.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace prowl {
namespace {

/// A tilted surface with a triangle for a patch.
Surface tilted() {
  Surface surface;
  surface.point = {0.3, -0.2, 0.1};
  surface.normal = Eigen::Vector3d(0.2, -0.3, 1.0).normalized();
  surface.patch = {{-0.2, -0.1}, {0.4, 0.0}, {0.0, 0.3}};
  return surface;
}

/// Distance of the patch's solid (down to 2 m) by brute force: the nearest of many of its points.
double nearest_of_samples(const Surface& surface, const Eigen::Vector3d& point) {
  double nearest = std::numeric_limits<double>::infinity();
  constexpr int kSteps = 60;
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; i + j <= kSteps; ++j) {
      const double u = static_cast<double>(i) / kSteps, w = static_cast<double>(j) / kSteps;
      const Eigen::Vector2d p =
          surface.patch[0] + u * (surface.patch[1] - surface.patch[0]) + w * (surface.patch[2] - surface.patch[0]);
      const double down = std::clamp(surface.distance(point), -2.0, 0.0);
      nearest = std::min(nearest, (surface.at(p, down) - point).norm());
    }
  }
  return nearest;
}

TEST(GroundDistance, OutsideOfAPatchIsTheDistanceOfItsSolid) {
  const Surface surface = tilted();
  std::mt19937 rng(1);
  std::uniform_real_distribution<double> uniform(-0.6, 0.6);
  int outside = 0, inside = 0;
  for (int i = 0; i < 300; ++i) {
    const Eigen::Vector3d point = surface.at({uniform(rng), uniform(rng)}, uniform(rng));
    const double distance = distance_from_ground(surface, point), expected = nearest_of_samples(surface, point);
    if (distance <= 0.0) {
      ++inside;
      EXPECT_LT(expected, 0.01);
      EXPECT_TRUE(surface.contains(surface.coordinates(point)));
      continue;
    }
    ++outside;
    EXPECT_NEAR(distance, expected, 0.01);  // spacing of the samples
  }
  EXPECT_GT(outside, 100);
  EXPECT_GT(inside, 5);
}

TEST(GroundDistance, InsideItIsTheWayOutOfTheNearestFace) {
  Surface surface;
  surface.patch = {{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}};
  EXPECT_DOUBLE_EQ(distance_from_ground(surface, {0.5, 0.5, -0.1}), -0.1);  // through the top
  EXPECT_DOUBLE_EQ(distance_from_ground(surface, {0.2, 0.5, -5.0}), -0.2);  // through the side, however deep
  EXPECT_DOUBLE_EQ(distance_from_ground(surface, {-0.3, 0.5, -5.0}), 0.3);
  EXPECT_DOUBLE_EQ(distance_from_ground(surface, {0.5, 0.5, 0.2}), 0.2);
  EXPECT_DOUBLE_EQ(distance_from_ground(surface, {-0.3, 0.5, 0.4}), 0.5);  // to the edge
  EXPECT_DOUBLE_EQ(distance_from_patch(surface, {-0.3, -0.4}), 0.5);       // to a corner
}

TEST(GroundDistance, APlaneWithoutAnEdgeIsEverywhere) {
  Surface surface = tilted();
  surface.patch.clear();
  EXPECT_EQ(distance_from_patch(surface, {1e3, -1e3}), -std::numeric_limits<double>::infinity());
  EXPECT_NEAR(distance_from_ground(surface, surface.at({50.0, -70.0}, -0.25)), -0.25, 1e-12);
}

}  // namespace
}  // namespace prowl
