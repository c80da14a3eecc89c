#include "prowl/mpc/ground_plane.hpp"

#include <gtest/gtest.h>

namespace prowl {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kSize = 0.6;

Vector3d on_slope(double x, double y) { return {x, y, 0.1 + 0.17 * x - 0.05 * y}; }

TEST(GroundPlane, GoesThroughTheContacts) {
  GroundPlane ground(4, kSize);
  EXPECT_EQ(ground.height({3.0, 4.0}), 0.0);
  for (int i = 0; i < 4; ++i) ground.see(i, on_slope(i < 2 ? 0.4 : -0.4, i % 2 == 0 ? 0.2 : -0.2));
  ground.fit(1.0);
  for (const Vector2d& place : {Vector2d(0.4, 0.2), Vector2d(-0.4, 0.2), Vector2d(0.8, 0.0)})
    EXPECT_NEAR(ground.height(place), on_slope(place.x(), place.y()).z(), 0.005);
  EXPECT_NEAR(ground.normal().x() / ground.normal().z(), -0.17, 0.01);
  EXPECT_NEAR(ground.normal().norm(), 1.0, 1e-12);
}

TEST(GroundPlane, MovesByAShare) {
  GroundPlane ground(1, kSize);
  ground.see(0, {0.0, 0.0, 0.2});
  ground.fit(0.25);
  EXPECT_NEAR(ground.height({0.0, 0.0}), 0.05, 1e-12);
  ground.fit(0.25);
  EXPECT_NEAR(ground.height({0.0, 0.0}), 0.0875, 1e-12);
  EXPECT_EQ(ground.normal(), Vector3d::UnitZ()) << "one contact tells no slope";
}

TEST(GroundPlane, ContactsOnALineTellTheSlopeAlongIt) {
  GroundPlane ground(2, kSize);
  ground.see(0, {0.4, 0.4, 0.1});
  ground.see(1, {-0.4, -0.4, -0.1});
  ground.fit(1.0);
  EXPECT_NEAR(ground.height({0.4, 0.4}), 0.1, 0.005);
  EXPECT_NEAR(ground.height({0.4, -0.4}), 0.0, 1e-12) << "across it the ground is level";
}

}  // namespace
}  // namespace prowl
