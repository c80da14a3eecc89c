#include "prowl/simulation/simulation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "prowl/dynamics/forward_dynamics.hpp"
#include "prowl/error.hpp"
#include "tests/simulation/standing_tracker.hpp"

namespace prowl {
namespace {

class Standing : public testing::Test {
 protected:
  MotionProblem problem_ = test::standing_problem();
  Tracker tracker_ = test::standing_tracker(problem_);
  SuccessCriteria criteria_;
};

TEST_F(Standing, SucceedsWithNoiseDelayAndEstimator) {
  const SimulationResult result = simulate(problem_, tracker_, criteria_, {});
  EXPECT_TRUE(result.success()) << result.failures.front();
  EXPECT_LT(result.base_position.rest, 0.01);
  EXPECT_GT(result.estimated_position.largest, 0.0) << "the estimator was not used";
  EXPECT_LT(result.estimated_position.largest, 5e-3);
  EXPECT_LT(result.estimated_velocity.largest, 0.05) << "the start is not known";
  EXPECT_LT(result.estimated_velocity.rest, 3e-3);
}

/// Without noise the estimate is the state.
TEST_F(Standing, EstimateIsTheTruthWithoutNoise) {
  SimulationOptions options;
  options.noise_scale = 0.0;
  options.pushes = {{{5.0, 5.0, 0.0}, 0.5, 0.1}};  // so that it moves
  const SimulationResult result = simulate(problem_, tracker_, criteria_, options);
  EXPECT_GT(result.base_position.largest, 2e-3) << "nothing moved";
  EXPECT_LT(result.estimated_position.largest, 5e-4);
  EXPECT_LT(result.estimated_angle.largest, 5e-4);
  EXPECT_LT(result.estimated_velocity.largest, 0.03) << "feet sink in at first";
  EXPECT_LT(result.estimated_velocity.rms, 2e-3);
}

TEST_F(Standing, FallsWithoutFeedbackAndUnderAStrongPush) {
  SimulationOptions options;
  options.open_loop = true;
  const SimulationResult open = simulate(problem_, tracker_, criteria_, options);
  EXPECT_FALSE(open.success());
  options = {};
  options.pushes = {{{0.0, 400.0, 0.0}, 0.3, 0.1}};
  const SimulationResult pushed = simulate(problem_, tracker_, criteria_, options);
  EXPECT_EQ(pushed.end, SimulationResult::End::fell);
  EXPECT_GT(pushed.end_time, 0.3);
}

TEST_F(Standing, IsTheSameBitForBitByItsSeed) {
  SimulationOptions options;
  options.record_rate = 100.0;
  const SimulationResult one = simulate(problem_, tracker_, criteria_, options),
                         two = simulate(problem_, tracker_, criteria_, options);
  options.seed = 2;
  const SimulationResult other = simulate(problem_, tracker_, criteria_, options);
  ASSERT_EQ(one.samples.size(), two.samples.size());
  ASSERT_GT(one.samples.size(), 100u);
  for (std::size_t i = 0; i < one.samples.size(); ++i) {
    ASSERT_EQ(one.samples[i].q, two.samples[i].q);
    ASSERT_EQ(one.samples[i].tau, two.samples[i].tau);
  }
  EXPECT_NE(one.samples.back().q, other.samples.back().q);
}

/// Contact forces of the standing robot, against those of the projected dynamics at its state under its torques.
TEST_F(Standing, ForcesAreThoseOfTheProjectedDynamics) {
  SimulationOptions options;
  options.perfect_state = true;
  options.record_rate = 100.0;
  const SimulationResult result = simulate(problem_, tracker_, criteria_, options);
  const SimulationSample& last = result.samples.back();
  ForwardDynamics dynamics(problem_.robot, {0, 1, 2, 3});
  dynamics.evaluate(last.q, last.v, last.tau);
  for (int c = 0; c < 4; ++c) {
    const Eigen::Vector3d expected = dynamics.forces().segment<3>(3 * c);
    EXPECT_LT((last.contacts[c].force - expected).norm(), 0.02 * expected.norm()) << c;
  }
}

/// A blow beyond all numbers: MuJoCo would start again from the nominal posture, and the rest would look like a
/// success.
TEST_F(Standing, EndsWhereTheStateIsNoNumber) {
  for (const bool perfect_state : {true, false}) {
    SimulationOptions options;
    options.perfect_state = perfect_state;
    options.record_rate = 1000.0;
    options.pushes = {{{0.0, 1e300, 0.0}, 0.3, 0.1}};
    const SimulationResult result = simulate(problem_, tracker_, criteria_, options);
    EXPECT_EQ(result.end, SimulationResult::End::diverged);
    EXPECT_FALSE(result.success());
    EXPECT_NEAR(result.end_time, 0.3, 0.02);
    for (const SimulationSample& sample : result.samples) EXPECT_TRUE(sample.q.allFinite() && sample.tau.allFinite());
  }
}

TEST_F(Standing, RefusesWhatMakesNoSense) {
  SimulationOptions options;
  options.delay = -1.0;
  EXPECT_THROW(simulate(problem_, tracker_, criteria_, options), InputError);
  options = {};
  options.physics.mass_scale = 0.0;
  EXPECT_THROW(simulate(problem_, tracker_, criteria_, options), InputError);
  const std::vector<std::function<void(SimulationOptions&)>> faults = {
      [](auto& o) { o.physics.body_scales = {1.0, 1.0}; },
      [](auto& o) { o.physics.body_scales.assign(13, -1.0); },
      [](auto& o) { o.physics.friction_scale = -0.5; },
      [](auto& o) { o.physics.base_center.x() = std::nan(""); },
      [](auto& o) { o.ground.height = std::nan(""); },
      [](auto& o) { o.unknown_noise = -1.0; },
      [](auto& o) { o.unknown_delay = -0.01; },
      [](auto& o) { o.start = StartError{.joints = Eigen::VectorXd::Zero(5)}; },
  };
  for (const auto& make : faults) {
    options = {};
    make(options);
    EXPECT_THROW(simulate(problem_, tracker_, criteria_, options), InputError);
  }
  EXPECT_THROW(simulate(test::standing_problem(test::go2()), tracker_, criteria_, {}), InputError);
}

/// A slope that is smoother than it is steep: standing feet slip, and that is said.
TEST(Simulation, SeesFeetSlip) {
  const MotionProblem slope = test::standing_problem(test::hyq(), 10.0);
  const Tracker tracker = test::standing_tracker(slope);
  SimulationOptions options;
  EXPECT_TRUE(simulate(slope, tracker, {}, options).success());
  options.physics.friction = 0.15;  // tan 10 degrees = 0.176
  const SimulationResult result = simulate(slope, tracker, {}, options);
  EXPECT_FALSE(result.success());
  EXPECT_GT(*std::ranges::max_element(result.slip), 0.03);
}

}  // namespace
}  // namespace prowl
