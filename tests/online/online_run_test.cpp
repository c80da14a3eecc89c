#include "prowl/online/online_run.hpp"

#include <gtest/gtest.h>

#include "prowl/error.hpp"
#include "tests/support/robots.hpp"

namespace prowl {
namespace {

OnlineOptions commanded(double forward) {
  OnlineOptions options;
  options.duration = 5.0;
  TimedCommand timed;
  timed.time = 0.5;
  timed.command.forward = forward;
  options.commands = {timed};
  return options;
}

TEST(OnlineRun, TrotsAsCommanded) {
  const RobotModel robot(test::hyq_description());
  const OnlineResult result = run_online(robot, commanded(0.3));
  EXPECT_TRUE(result.success()) << result.failures.front();
  EXPECT_LT(result.velocity_error, 0.1);
  EXPECT_GT(result.path.back()(1), 1.0) << "distance ahead [m]";
  EXPECT_EQ(result.counters.damped, 0);
  EXPECT_LE(result.largest_torque_share, 1.0 + 1e-12);
}

TEST(OnlineRun, RepeatsBitForBit) {
  const RobotModel robot(test::hyq_description());
  OnlineOptions options = commanded(0.2);
  options.duration = 1.5;
  options.simulation.pushes = {{{10.0, 10.0, 0.0}, 0.8, 0.1}};
  const OnlineResult once = run_online(robot, options), again = run_online(robot, options);
  ASSERT_EQ(once.path.size(), again.path.size());
  for (std::size_t i = 0; i < once.path.size(); ++i) EXPECT_EQ(once.path[i], again.path[i]) << i;
  options.simulation.seed = 2;
  EXPECT_NE(run_online(robot, options).path.back(), once.path.back()) << "noise does nothing";
}

TEST(OnlineRun, LatePlansAreLostAndTheirTimesRepeatTheRun) {
  const RobotModel robot(test::hyq_description());
  OnlineOptions options = commanded(0.2);
  options.duration = 1.5;
  options.late = LatePlans::drop;
  options.replayed_times.assign(150, 1e-3);
  for (std::size_t i = 20; i < 150; i += 7) options.replayed_times[i] = 1.0;
  const OnlineResult once = run_online(robot, options), again = run_online(robot, options);
  EXPECT_EQ(once.dropped, 19);
  EXPECT_EQ(once.path.back(), again.path.back());
  EXPECT_EQ(once.end, OnlineResult::End::finished) << "the plan before goes on";
}

TEST(OnlineRun, TellsAFall) {
  const RobotModel robot(test::hyq_description());
  OnlineOptions options = commanded(0.0);
  options.simulation.pushes = {{{0.0, 10.0 * robot.mass(), 0.0}, 0.8, 0.1}};
  const OnlineResult result = run_online(robot, options);
  EXPECT_EQ(result.end, OnlineResult::End::fell);
  EXPECT_LT(result.end_time, 3.0);
  EXPECT_FALSE(result.success());
}

TEST(OnlineRun, RefusesOptionsOutOfRange) {
  const RobotModel robot(test::hyq_description());
  OnlineOptions options;
  options.gait = "gallop";
  EXPECT_THROW(run_online(robot, options), InputError);
  options = {};
  options.budget = -1.0;
  EXPECT_THROW(run_online(robot, options), InputError);
}

}  // namespace
}  // namespace prowl
