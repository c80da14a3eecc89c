#include "prowl/mpc/horizon_grid.hpp"

#include <gtest/gtest.h>

#include <random>

namespace prowl {
namespace {

TEST(HorizonGrid, StepsGrowFromTheFirst) {
  HorizonGrid grid(20, 0.015, 0.7);
  grid.lay(3.0, ContactTimeline(4, 0.0));
  EXPECT_DOUBLE_EQ(grid.time(0), 3.0);
  EXPECT_NEAR(grid.end(), 3.7, 1e-12);
  EXPECT_NEAR(grid.step(0), 0.015, 1e-6);
  for (int k = 1; k < 20; ++k) EXPECT_GT(grid.step(k), grid.step(k - 1)) << k;
}

TEST(HorizonGrid, NoSwitchIsInsideAStep) {
  std::mt19937 random(5);
  ContactTimeline timeline(4, 0.0);
  timeline.follow({.groups = {{2}, {0}, {3}, {1}}, .stride = 0.61, .duty_factor = 0.78});
  HorizonGrid grid(20, 0.015, 0.7);
  HorizonGrid plain = grid;
  plain.lay(0.0, ContactTimeline(4, 0.0));
  const double last_step = plain.step(19);
  long at_nodes = 0;
  for (int i = 0; i < 500; ++i) {
    const double start = std::uniform_real_distribution<double>(0.02 * i, 0.02 * i + 0.02)(random);
    timeline.extend(start, start + 1.0);
    grid.lay(start, timeline);
    for (int k = 0; k < grid.num_steps(); ++k) {
      EXPECT_GT(grid.step(k), 3.9e-3) << start << ", step " << k;
      std::vector<double> inside;
      timeline.add_switches(grid.time(k) + 1e-12, grid.time(k + 1) - 1e-12, inside);
      for (const double t : inside) {  // one that is too near to another or to the start, or in the last half step
        const double to_node = t - grid.time(k), near = 0.5 * plain.step(plain.step_at(t - start));
        if (t < grid.end() - 0.5 * last_step) EXPECT_LT(to_node, std::max(4.1e-3, near)) << start << ", step " << k;
      }
      EXPECT_EQ(grid.step_at(grid.middle(k)), k);
      if (timeline.standing(grid.time(k) - 1e-9) != timeline.standing(grid.time(k) + 1e-9)) ++at_nodes;
    }
    EXPECT_GT(grid.step(grid.num_steps() - 1), 0.49 * last_step) << "a landing has room before the end";
  }
  EXPECT_GT(at_nodes, 500 * 3) << "four feet land in a stride, and the horizon is longer";
}

/// A step much longer than its neighbours has an error that is much larger, and its program may have no solution.
TEST(HorizonGrid, SwitchesMakeNoStepLong) {
  std::mt19937 random(6);
  HorizonGrid plain(20, 0.015, 0.744);
  plain.lay(0.0, ContactTimeline(4, 0.0));
  ContactTimeline walk(4, 0.0);
  walk.follow({.groups = {{2}, {0}, {3}, {1}}, .stride = 0.744, .duty_factor = 0.77});
  HorizonGrid grid = plain;
  for (int i = 0; i < 500; ++i) {
    const double start = std::uniform_real_distribution<double>(0.02 * i, 0.02 * i + 0.02)(random);
    walk.extend(start, start + 1.0);
    grid.lay(start, walk);
    for (int k = 0; k < grid.num_steps(); ++k)
      EXPECT_LT(grid.step(k), 2.0 * plain.step(plain.step_at(grid.middle(k) - start))) << start << ", step " << k;
  }
}

}  // namespace
}  // namespace prowl
