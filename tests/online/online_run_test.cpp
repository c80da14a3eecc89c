#include "prowl/online/online_run.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "prowl/error.hpp"
#include "prowl/online/random_events.hpp"
#include "tests/support/robots.hpp"

namespace prowl {
namespace {

OnlineOptions commanded(double forward) {
  OnlineOptions options;
  options.duration = 5.0;
  options.simulation.record_rate = 10.0;
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
  EXPECT_GT(result.samples.back().q.x(), 1.0) << "distance ahead [m]";
  EXPECT_EQ(result.counters.damped, 0);
  EXPECT_LE(result.largest_torque_share, 1.0 + 1e-12);
  EXPECT_EQ(result.steps_beyond_limits, 0);
  EXPECT_GT(result.undisturbed.plans, 450);
  EXPECT_LE(result.undisturbed.share(), 0.02) << "forces outside their cones, by the oracle of the certificate";
  EXPECT_EQ(result.kicked.plans, 0);
}

TEST(OnlineRun, BipedWalksAsCommanded) {
  const RobotModel robot(test::talos_description());
  OnlineOptions options = commanded(0.2);
  options.gait = "walk";
  options.period = options.budget = 0.04;
  const OnlineResult result = run_online(robot, options);
  EXPECT_TRUE(result.success()) << result.failures.front();
  EXPECT_GT(result.samples.back().q.x(), 0.5) << "distance ahead [m]";
  EXPECT_EQ(result.steps_beyond_limits, 0);
}

TEST(OnlineRun, RepeatsBitForBit) {
  const RobotModel robot(test::hyq_description());
  OnlineOptions options = commanded(0.2);
  options.duration = 1.5;
  options.simulation.pushes = {{{10.0, 10.0, 0.0}, 0.8, 0.1}};
  const OnlineResult once = run_online(robot, options), again = run_online(robot, options);
  ASSERT_EQ(once.samples.size(), again.samples.size());
  for (std::size_t i = 0; i < once.samples.size(); ++i) EXPECT_EQ(once.samples[i].q, again.samples[i].q) << i;
  options.simulation.seed = 2;
  EXPECT_NE(run_online(robot, options).samples.back().q, once.samples.back().q) << "noise does nothing";
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
  EXPECT_EQ(once.late, 19);
  EXPECT_EQ(once.samples.back().q, again.samples.back().q);
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

TEST(OnlineRun, AWatcherCommandsKicksAndStops) {
  const RobotModel robot(test::hyq_description());
  OnlineOptions options = commanded(0.0);
  double last = -1.0;
  const OnlineResult result = run_online(robot, options, [&](OnlineMoment& moment) {
    const OnlineSample now = moment.sample();
    EXPECT_EQ(now.time, moment.time);
    EXPECT_GT(moment.time, last);
    last = moment.time;
    const auto is_at = [&](double t) { return std::abs(moment.time - t) < 1e-9; };
    if (is_at(0.5)) moment.command = {.command = {.forward = 9.0}};
    if (is_at(0.6)) moment.command = {.command = {.forward = 0.3}, .gait = "canter"};
    if (is_at(0.7)) moment.impulse = Eigen::Vector3d(0.0, 20.0, 0.0);
    moment.stops = is_at(2.0);
  });
  EXPECT_EQ(result.end, OnlineResult::End::stopped);
  EXPECT_NEAR(result.end_time, 2.0, 1e-9);
  EXPECT_FALSE(result.last_velocity) << "it ended before";
  EXPECT_NEAR(result.samples.back().commanded.x(), 0.3, 1e-9);
  EXPECT_GT(result.kicked.plans, 50);
  ASSERT_EQ(result.notes.size(), 2);
  EXPECT_NE(result.notes[0].find("out of range"), std::string::npos) << result.notes[0];
  EXPECT_NE(result.notes[1].find("canter"), std::string::npos) << result.notes[1];
}

TEST(OnlineRun, RefusesGaitsOfItsCommandsBeforeItBegins) {
  const RobotModel robot(test::hyq_description());
  OnlineOptions options = commanded(0.0);
  options.commands.push_back({.time = 4.0, .command = {}, .gait = "canter"});
  int steps = 0;
  EXPECT_THROW(run_online(robot, options, [&](OnlineMoment&) { ++steps; }), InputError);
  EXPECT_EQ(steps, 0);
}

TEST(OnlineRun, RefusesOptionsOutOfRange) {
  const RobotModel robot(test::hyq_description());
  OnlineOptions options;
  options.gait = "gallop";
  EXPECT_THROW(run_online(robot, options), InputError);
  options = {};
  options.budget = -1.0;
  EXPECT_THROW(run_online(robot, options), InputError);
  options = {};
  options.budget = 0.05;
  options.simulation.delay = 0.03;
  EXPECT_THROW(run_online(robot, options), InputError) << "more than the kept plans cover";
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Push& push : {Push{{0.0, nan, 0.0}, 0.1}, Push{{0.0, 1.0, 0.0}, nan}, Push{{0.0, 1.0, 0.0}, -1.0},
                           Push{{0.0, 1.0, 0.0}, 0.1, nan}, Push{{0.0, 1.0, 0.0}, 0.1, 0.0}}) {
    options = {};
    options.simulation.pushes = {push};
    EXPECT_THROW(run_online(robot, options), InputError);
  }
  for (const double second : {0.5, nan}) {
    options = {};
    options.commands = {{.time = 1.0, .command = {}}, {.time = second, .command = {}}};
    EXPECT_THROW(run_online(robot, options), InputError) << "commands are followed in order of time";
  }
  const auto refuses = [&](auto&& change) {
    OnlineOptions changed;
    change(changed);
    EXPECT_THROW(run_online(robot, changed), InputError);
  };
  for (const double value : {-1.0, nan}) {
    refuses([&](OnlineOptions& bad) { bad.simulation.noise_scale = value; });
    refuses([&](OnlineOptions& bad) { bad.simulation.physics.friction = value; });
    refuses([&](OnlineOptions& bad) { bad.simulation.physics.mass_scale = value; });
    refuses([&](OnlineOptions& bad) { bad.simulation.record_rate = value; });
    refuses([&](OnlineOptions& bad) { bad.mpc.friction = value; });
    refuses([&](OnlineOptions& bad) { bad.replayed_times = {0.001, value}; });
    options = {};
    EXPECT_THROW(add_kicks(robot, value, options), InputError);
    EXPECT_THROW(add_random_commands(value, options), InputError);
  }
  options.duration = 3.0;
  EXPECT_THROW(add_kicks(robot, 0.5, options), InputError) << "without a kick";
}

TEST(OnlineRun, TellsWhatItDoesNotDo) {
  const RobotModel robot(test::hyq_description());
  OnlineOptions options = commanded(0.2);
  options.duration = 0.3;
  options.simulation.pushes = {{{0.0, 1.0, 0.0}, 1.0}};
  options.replayed_times.assign(10, 1e-3);
  const OnlineResult result = run_online(robot, options);
  ASSERT_EQ(result.notes.size(), 3U);
  EXPECT_NE(result.notes[0].find("command at 0.5 s"), std::string::npos) << result.notes[0];
  EXPECT_NE(result.notes[1].find("push at 1 s"), std::string::npos) << result.notes[1];
  EXPECT_NE(result.notes[2].find("replayed times end at 0.10 s"), std::string::npos) << result.notes[2];
}

}  // namespace
}  // namespace prowl
