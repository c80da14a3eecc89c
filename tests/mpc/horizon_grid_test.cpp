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
  const double last_step = grid.step(19);  // without switches
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
        const double to_node = std::min(t - grid.time(k), grid.time(k + 1) - t);
        if (t < grid.end() - 0.5 * last_step) EXPECT_LT(to_node, 4.1e-3) << start << ", step " << k;
      }
      EXPECT_EQ(grid.step_at(grid.middle(k)), k);
      for (int foot = 0; foot < 4; ++foot) {
        const ContactTimeline::Swing* const swing = timeline.swing(foot, grid.time(k));
        if (swing && swing->lift == grid.time(k)) ++at_nodes;
      }
    }
    EXPECT_GT(grid.step(grid.num_steps() - 1), 0.49 * last_step) << "a landing has room before the end";
  }
  EXPECT_GT(at_nodes, 500 * 3) << "lift-offs at nodes: four a stride, and the horizon is longer";
}

}  // namespace
}  // namespace prowl
