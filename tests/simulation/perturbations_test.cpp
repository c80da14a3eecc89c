#include "prowl/simulation/perturbations.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "prowl/error.hpp"
#include "tests/simulation/standing_tracker.hpp"

namespace prowl {
namespace {

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
TEST(Perturbations, AreDrawnFromTheirRanges) {
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

TEST(Perturbations, TakePushesOfOnesOwn) {
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

/// What belongs to each kind; seeds of the sensors are no perturbation.
bool is_same(const std::string& kind, const SimulationOptions& a, const SimulationOptions& b) {
  const auto start = [](const SimulationOptions& o) {
    Eigen::VectorXd all(12 + o.start->joints.size());
    all << o.start->base, o.start->twist, o.start->joints;
    return all;
  };
  if (kind == "start") return start(a) == start(b);
  if (kind == "mass") return a.physics.body_scales == b.physics.body_scales;
  if (kind == "center") return a.physics.base_center == b.physics.base_center;
  if (kind == "friction") return a.physics.friction_scale == b.physics.friction_scale;
  if (kind == "bandwidth") return a.bandwidth == b.bandwidth;
  if (kind == "delay") return a.unknown_delay == b.unknown_delay;
  if (kind == "ground") return a.ground.height == b.ground.height && a.ground.tilt == b.ground.tilt;
  if (kind == "noise") return a.unknown_noise == b.unknown_noise;
  if (kind == "push") return std::ranges::equal(a.pushes, b.pushes, {}, &Push::impulse, &Push::impulse);
  ADD_FAILURE() << kind;
  return false;
}

/// A kind that is drawn has the same values as among all; the others are as in a simulation without perturbations.
TEST(Perturbations, AreLeftOutByKind) {
  const MotionProblem problem = test::standing_problem();
  const Tracker tracker = test::standing_tracker(problem);
  SimulationOptions none;
  none.start.emplace().joints.setZero(problem.robot.nu());
  none.physics.body_scales.assign(static_cast<std::size_t>(problem.robot.nu()) + 1, 1.0);
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const SimulationOptions all = perturbed(problem, tracker, {}, only({}), seed);
    for (const std::string& kind : perturbation_kinds()) {
      const SimulationOptions alone = perturbed(problem, tracker, {}, only({kind}), seed);
      EXPECT_EQ(alone.seed, all.seed);
      for (const std::string& other : perturbation_kinds()) {
        EXPECT_TRUE(is_same(other, alone, other == kind ? all : none)) << other << " of " << kind << " alone";
        EXPECT_FALSE(is_same(other, alone, other == kind ? none : all)) << other << " of " << kind << " alone";
      }
    }
  }
  EXPECT_THROW(only({"pushes"}), InputError);
}

}  // namespace
}  // namespace prowl
