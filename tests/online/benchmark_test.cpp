#include "prowl/online/benchmark.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <tuple>
#include <utility>

#include "prowl/mpc/stepping_patterns.hpp"
#include "prowl/online/pendulum_bound.hpp"
#include "tests/support/robots.hpp"

namespace prowl {
namespace {

TEST(Benchmark, RunsDependOnTheirSeedsAlone) {
  const RobotModel robot(test::hyq_description());
  std::set<std::string> names;
  for (const BenchmarkRow& row : benchmark_rows(robot, {})) {
    EXPECT_TRUE(names.insert(row.name).second) << row.name;
    EXPECT_GE(row.seeds, 1);
    const OnlineOptions one = row.run(robot, 7), again = row.run(robot, 7), other = row.run(robot, 8);
    const std::vector<Push>&pushes = one.simulation.pushes, &same = again.simulation.pushes;
    ASSERT_EQ(pushes.size(), same.size());
    EXPECT_EQ(row.kick > 0.0, !pushes.empty()) << row.name;
    for (std::size_t i = 0; i < pushes.size(); ++i) {
      EXPECT_EQ(pushes[i].impulse, same[i].impulse);
      EXPECT_NE(pushes[i].impulse, other.simulation.pushes[i].impulse);
      EXPECT_NEAR(pushes[i].impulse.norm(), row.kick * robot.mass(), 1e-9);
      EXPECT_EQ(pushes[i].impulse.z(), 0.0);
    }
    EXPECT_EQ(row.events == BenchmarkRow::Events::commands, !one.commands.empty()) << row.name;
    EXPECT_EQ(row.pendulum > 0.0, row.kick > 0.0) << row.name;
  }
  for (const char* const name : {"ticks", "trot_commands", "walk_commands", "kicks_0.5", "kicks_1.0", "one_kick_0.5",
                                 "curve_0.2", "curve_1.2", "payload", "friction", "slope", "hour"})
    EXPECT_TRUE(names.contains(name)) << name;
}

/// A simulation of the pendulum from the kick to many steps, each as far as the bound assumes.
bool pendulum_rests(double kick, double rate, double reach, double step) {
  double x = 0.0, v = kick, left = 0.5 * step;  // from the foot
  for (int steps = 0; steps < 60; ++steps, left = step) {
    const double c = std::cosh(rate * left), s = std::sinh(rate * left);
    std::tie(x, v) = std::pair(x * c + v / rate * s, x * rate * s + v * c);
    x -= std::min(reach, x + v / rate);  // the foot steps to the capture point, if it can
    if (x + v / rate < 1e-9) return true;
  }
  return false;
}

TEST(PendulumBound, IsWhereAPendulumCannotComeToRestAnyMore) {
  const RobotModel robot(test::hyq_description());
  const auto feet = contacts_of_feet(robot);
  const double height = standing_on_ground(robot).z(), rate = std::sqrt(RobotModel::kGravity / height);
  const SteppingPattern pattern = stepping_pattern(robot, feet, height, "trot");
  const double bound = pendulum_bound(robot, feet, height, pattern), step = 0.5 * pattern.stride;
  const double reach = bound / rate * std::exp(0.5 * rate * step) * (1.0 - std::exp(-rate * step));
  EXPECT_NEAR(reach, std::sqrt(0.7 * 0.7 - height * height), 0.1) << "HyQ's legs are 0.35 m and 0.35 m long";
  EXPECT_TRUE(pendulum_rests(0.999 * bound, rate, reach, step));
  EXPECT_FALSE(pendulum_rests(1.001 * bound, rate, reach, step));
  EXPECT_EQ(pendulum_bound(robot, feet, height, {}), 0.0) << "a robot that stands";
}

}  // namespace
}  // namespace prowl
