#include "prowl/simulation/sweep.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "tests/simulation/standing_tracker.hpp"

namespace prowl {
namespace {

/// Clopper and Pearson's bounds p are where the binomial tail from the outcome on has 2.5 %.
TEST(SuccessRate, BoundsCutOffTheTails) {
  const auto tail = [](int cases, int from, double p) {  // P(X >= from)
    double sum = 0.0;
    for (int k = from; k <= cases; ++k) {
      sum += std::exp(std::lgamma(cases + 1) - std::lgamma(k + 1) - std::lgamma(cases - k + 1) + k * std::log(p) +
                      (cases - k) * std::log1p(-p));
    }
    return sum;
  };
  for (const int successes : {1, 10, 100, 195, 199}) {
    const SuccessRate rate = success_rate(successes, 200);
    EXPECT_NEAR(tail(200, successes, rate.lower), 0.025, 1e-6) << successes;
    EXPECT_NEAR(1.0 - tail(200, successes + 1, rate.upper), 0.025, 1e-6) << successes;
  }
  EXPECT_EQ(success_rate(0, 200).lower, 0.0);
  EXPECT_EQ(success_rate(200, 200).upper, 1.0);
}

struct Range {
  double least = 1e9, most = -1e9;
  void add(double value) {
    least = std::min(least, value);
    most = std::max(most, value);
  }
  void expect(double low, double high, const char* what) const {
    const double some = 0.02 * (high - low);
    EXPECT_GE(least, low) << what;
    EXPECT_LE(most, high) << what;
    EXPECT_NEAR(least, low, some) << what;
    EXPECT_NEAR(most, high, some) << what;
  }
};

/// Lengths scale with the height of the robot, velocities with its root; the rest is the same for all.
TEST(Sweep, DrawsFromItsRanges) {
  for (const RobotModel& robot : {test::hyq(), test::solo12()}) {
    const MotionProblem problem = test::standing_problem(robot);
    const Tracker tracker = test::standing_tracker(problem);
    const double height = robot.nominal_configuration().z() / 0.58, root = std::sqrt(height);
    Range position, angle, velocity, rate, joint, mass, center, friction, bandwidth, delay, ground, tilt, noise, time;
    std::set<std::uint64_t> seeds;
    for (std::uint64_t seed = 1; seed <= 2000; ++seed) {
      const SimulationOptions options = perturbed(problem, tracker, {}, {}, seed);
      seeds.insert(options.seed);
      position.add(options.start->base(2));
      angle.add(options.start->base(3));
      velocity.add(options.start->twist(0));
      rate.add(options.start->twist(5));
      joint.add(options.start->joints(4));
      ASSERT_EQ(std::ssize(options.physics.body_scales), robot.nu() + 1);
      mass.add(options.physics.body_scales[3]);
      center.add(options.physics.base_center.y());
      friction.add(options.physics.friction_scale);
      bandwidth.add(options.bandwidth);
      delay.add(options.delay + options.unknown_delay);
      ground.add(options.ground.height);
      tilt.add(options.ground.tilt.x());
      noise.add(options.unknown_noise);
      const Push& push = options.pushes.at(0);
      time.add(push.time);
      EXPECT_EQ(push.impulse.z(), 0.0);
      EXPECT_NEAR(push.impulse.norm(), 0.12 * root * robot.mass(), 1e-9);
      EXPECT_EQ(push.duration, 0.1);
    }
    EXPECT_EQ(seeds.size(), 2000u);
    position.expect(-0.01 * height, 0.01 * height, "position");
    angle.expect(-0.02, 0.02, "angle");
    velocity.expect(-0.05 * root, 0.05 * root, "velocity");
    rate.expect(-0.1, 0.1, "rate");
    joint.expect(-0.01, 0.01, "joint");
    mass.expect(0.9, 1.1, "mass");
    center.expect(-0.02 * height, 0.02 * height, "centre of mass");
    friction.expect(0.8, 1.6, "friction");
    bandwidth.expect(20.0, 60.0, "bandwidth");
    delay.expect(1e-3, 4e-3, "delay");
    ground.expect(-5e-3 * height, 5e-3 * height, "ground");
    tilt.expect(-0.035, 0.035, "tilt");
    noise.expect(0.5, 2.0, "noise");
    time.expect(0.0, 2.0, "time of the push");
  }
}

TEST(Sweep, TakesPushesOfOnesOwn) {
  const MotionProblem problem = test::standing_problem();
  TrackingPlan plan = test::standing_tracker(problem).plan();
  plan.segments = {{"four", 0.0, 1.0, 0, 2, {true, true, true, true}},
                   {"two", 1.0, 2.0, 2, 2, {true, false, false, true}}};
  for (Eigen::MatrixXd* part : {&plan.q, &plan.v, &plan.tau, &plan.gains}) *part = part->replicate(1, 2).eval();
  const Tracker tracker(plan);
  PerturbationRanges ranges;
  ranges.push = 10.0;
  ranges.push_on_two_feet = 2.0;
  int weak = 0;
  for (std::uint64_t seed = 1; seed <= 500; ++seed) {
    const Push push = perturbed(problem, tracker, {}, ranges, seed).pushes.at(0);
    const bool on_two = push.time + push.duration >= 1.0;
    EXPECT_NEAR(push.impulse.norm(), on_two ? 2.0 : 10.0, 1e-12) << push.time;
    weak += on_two ? 1 : 0;
  }
  EXPECT_NEAR(weak, 275, 50);
}

/// A case of a sweep is what simulate() makes of it, and all of them are there, in order.
TEST(Sweep, CasesCanBeReplayed) {
  MotionProblem problem = test::standing_problem();
  problem.phases.front().duration = {0.3, 0.3};
  const Tracker tracker = test::standing_tracker(problem);
  const SuccessCriteria criteria{.rest = 0.3};
  std::vector<SimulationOptions> options;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) options.push_back(perturbed(problem, tracker, {}, {}, seed));
  int last = -1;
  const auto cases = run_cases(
      problem, tracker, criteria, options,
      [&](int done, int total) {
        EXPECT_EQ(done, ++last);
        EXPECT_EQ(total, 6);
      },
      nullptr);
  ASSERT_EQ(cases.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) {
    const SimulationResult again = simulate(problem, tracker, criteria, options[i]);
    EXPECT_EQ(cases[i].result.base_position.largest, again.base_position.largest);
    EXPECT_EQ(cases[i].result.positive_work, again.positive_work);
  }
  EXPECT_NE(cases[0].result.positive_work, cases[1].result.positive_work);
  EXPECT_EQ(last, 6);
  const std::atomic<bool> stop = true;
  EXPECT_TRUE(run_cases(problem, tracker, criteria, options, {}, &stop).empty());
}

class Interrupted : public testing::Test {
 protected:
  static MotionProblem short_problem() {
    MotionProblem problem = test::standing_problem();
    problem.phases.front().duration = {0.1, 0.1};
    return problem;
  }
  MotionProblem problem_ = short_problem();
  Tracker tracker_ = test::standing_tracker(problem_);
  SuccessCriteria criteria_{.rest = 0.1};
};

/// What had begun is finished and kept: the first cases, without gaps, each as without an interrupt.
TEST_F(Interrupted, KeepsTheCasesThatHadBegun) {
  std::vector<SimulationOptions> options;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) options.push_back(perturbed(problem_, tracker_, {}, {}, seed));
  std::atomic<bool> stop = false;
  int told = 0;
  const auto cases = run_cases(
      problem_, tracker_, criteria_, options,
      [&](int done, int) {
        told = done;
        if (done >= 3) stop = true;
      },
      &stop);
  EXPECT_GE(cases.size(), 3u);
  EXPECT_LT(cases.size(), 200u);
  EXPECT_EQ(static_cast<int>(cases.size()), told) << "a case that was finished is missing";
  for (std::size_t i = 0; i < cases.size(); ++i) EXPECT_EQ(cases[i].options.seed, options[i].seed);
}

/// Progress goes up to what it said at first, whatever sizes are left out; a kind that is not found is not there.
TEST_F(Interrupted, LeavesOutKindsThatAreNotFound) {
  int last = -1, most = 0;
  const auto all = find_breakdowns(
      problem_, tracker_, criteria_, {}, 1, 1,
      [&](int done, int total) {
        EXPECT_GE(done, last);
        if (last >= 0) EXPECT_EQ(total, most);
        last = done;
        most = total;
      },
      nullptr);
  ASSERT_EQ(all.size(), 6u);
  EXPECT_EQ(last, most);

  for (const int after : {1, most / 2, most}) {
    std::atomic<bool> stop = false;
    const auto some = find_breakdowns(
        problem_, tracker_, criteria_, {}, 1, 1, [&](int done, int) { stop = stop || done >= after; }, &stop);
    EXPECT_LT(some.size(), 6u + (after == most ? 1u : 0u));
    for (std::size_t i = 0; i < some.size(); ++i) {
      EXPECT_EQ(some[i].kind, all[i].kind);
      EXPECT_EQ(some[i].holds, all[i].holds);
      EXPECT_EQ(some[i].fails, all[i].fails);
    }
    if (after == 1) EXPECT_TRUE(some.empty());
    if (after == most / 2) EXPECT_FALSE(some.empty());
  }
}

}  // namespace
}  // namespace prowl
