#include "prowl/guess/monotone_cubic.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace prowl {
namespace {

const std::vector<Waypoint> kWaypoints = {{0.0, 1.0, {}}, {0.5, 1.2, {}},  {2.0, 3.0, {}},
                                          {2.5, 3.0, {}}, {3.0, -1.0, {}}, {4.5, 0.0, {}}};

double slope(const MonotoneCubic& curve, double time) { return (curve(time + 1e-6) - curve(time - 1e-6)) / 2e-6; }

TEST(MonotoneCubic, GoesThroughItsWaypointsAndStaysBetweenThem) {
  const MonotoneCubic curve(kWaypoints);
  for (std::size_t i = 0; i + 1 < kWaypoints.size(); ++i) {
    const auto& [t0, value0, s0] = kWaypoints[i];
    const auto& [t1, value1, s1] = kWaypoints[i + 1];
    EXPECT_DOUBLE_EQ(curve(t0), value0);
    EXPECT_DOUBLE_EQ(curve(t1), value1);
    double last = value0;
    for (int k = 1; k <= 100; ++k) {
      const double value = curve(t0 + (t1 - t0) * k / 100.0);
      EXPECT_GE((value - last) * (value1 - value0), -1e-15) << "not monotone after waypoint " << i;
      last = value;
    }
  }
}

TEST(MonotoneCubic, IsSmoothAndAtRestAtItsEndsAndTurns) {
  const MonotoneCubic curve(kWaypoints);
  for (const Waypoint& waypoint : kWaypoints) {
    const double after = (curve(waypoint.time + 1e-6) - waypoint.value) / 1e-6;
    const double before = (waypoint.value - curve(waypoint.time - 1e-6)) / 1e-6;
    EXPECT_NEAR(after, before, 1e-4);
  }
  for (const double rest : {0.0, 2.0, 2.5, 3.0, 4.5}) EXPECT_NEAR(slope(curve, rest), 0.0, 1e-4);
  EXPECT_GT(slope(curve, 0.5), 0.5) << "on its way up it does not stop";
}

TEST(MonotoneCubic, TakesGivenSlopes) {
  const MonotoneCubic curve({{0.0, 0.0, {}}, {1.0, 1.0, 0.3}, {2.0, 2.0, {}}});
  EXPECT_NEAR(slope(curve, 1.0), 0.3, 1e-5);
  const MonotoneCubic line({{0.0, 1.0, 2.0}, {3.0, 7.0, 2.0}});
  for (const double t : {0.3, 1.0, 2.7}) EXPECT_NEAR(line(t), 1.0 + 2.0 * t, 1e-14);
}

TEST(MonotoneCubic, KeepsAStraightLineStraight) {
  const MonotoneCubic line({{0.0, 1.0, 2.0}, {1.0, 3.0, {}}, {3.0, 7.0, {}}, {3.5, 8.0, 2.0}});
  for (const double t : {0.2, 0.9, 1.5, 2.8, 3.4}) EXPECT_NEAR(line(t), 1.0 + 2.0 * t, 1e-14);
}

TEST(MonotoneCubic, IsConstantBeyondItsEnds) {
  const MonotoneCubic curve(kWaypoints);
  EXPECT_EQ(curve(-3.0), 1.0);
  EXPECT_EQ(curve(9.0), 0.0);
  EXPECT_EQ(MonotoneCubic({{1.0, 5.0, {}}})(0.0), 5.0);
}

}  // namespace
}  // namespace prowl
