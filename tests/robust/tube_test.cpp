// The tube of HyQ's crouch against rollouts of its closed loop, which are not linear.
#include "prowl/robust/tube.hpp"

#include <gtest/gtest.h>

#include <random>

#include "prowl/model/configuration.hpp"
#include "prowl/tracking/displaced_start.hpp"
#include "prowl/tracking/make_tracking_plan.hpp"
#include "prowl/tracking/rollout.hpp"
#include "tests/support/solved_task.hpp"

namespace prowl {
namespace {

class TubeOfCrouch : public ::testing::Test {
 protected:
  test::SolvedTask solved_ = test::solve_task("hyq/crouch");
  const MotionProblem& problem_ = solved_.task.problem;

  Tube tube(const Disturbances& sizes) const {
    return closed_loop(problem_, solved_.trajectory, solved_.task.tracking, sizes).tube;
  }
};

TEST_F(TubeOfCrouch, HoldsRolloutsFromDisplacedStarts) {
  const Disturbances sizes{.base_position = 0.005, .base_angle = 0.01};
  const FeedbackDesign design = design_feedback(problem_, solved_.trajectory, solved_.task.tracking);
  const Tube::OfPhase phase = tube(sizes).phases.front();
  const Tracker tracker(make_tracking_plan(problem_, design));
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  constexpr int kRuns = 100;
  const Eigen::Index nv = problem_.robot.nv();
  const std::vector<double> times{0.1, 0.3, 0.6};
  std::vector<Eigen::VectorXd> squares(times.size(), Eigen::VectorXd::Zero(nv));
  for (int run = 0; run < kRuns; ++run) {
    Eigen::Matrix<double, 6, 1> displacement;
    for (int i = 0; i < 6; ++i) displacement(i) = (i < 3 ? sizes.base_position : sizes.base_angle) * unit(random);
    const StartState start = displaced_start(problem_.robot, tracker, displacement);
    const Rollout run_of = rollout(problem_.robot, tracker, start.q, start.v, {.sample_step = 0.1, .tolerance = 1e-5});
    ASSERT_FALSE(run_of.fell);
    for (std::size_t i = 0; i < times.size(); ++i) {
      const auto at = std::ranges::find_if(run_of.samples, [&](const auto& s) { return s.time > times[i] - 1e-9; });
      Eigen::VectorXd q(problem_.robot.nq()), v(nv);
      tracker.reference(at->time, q, v);
      squares[i] += difference(q, at->q).cwiseAbs2();
    }
  }
  for (std::size_t i = 0; i < times.size(); ++i) {
    const auto at = std::ranges::lower_bound(phase.times, times[i] - 1e-9) - phase.times.begin();
    const Eigen::VectorXd measured = (squares[i] / kRuns).cwiseSqrt(), predicted = phase.state.col(at).head(nv);
    // Of 100 runs the deviation is known to 7 %.
    for (Eigen::Index j = 0; j < nv; ++j)
      EXPECT_NEAR(measured(j), predicted(j), 0.25 * predicted(j) + 1e-5) << times[i] << " s, coordinate " << j;
  }
}

/// A body heavier by a share needs that share more of its weight, sooner or later: the base sinks.
TEST_F(TubeOfCrouch, GrowsFromNothingWithUnknownMasses) {
  const Tube::OfPhase phase = tube({.mass = 0.1, .center = 0.02}).phases.front();
  EXPECT_LT(phase.state.col(0).norm(), 1e-12);
  EXPECT_GT(phase.state(2, phase.state.cols() - 1), 1e-4) << "base z";
  EXPECT_GT(phase.needed.cone.col(0).minCoeff(), 0.1) << "loads differ at once";
}

/// To first order.
TEST_F(TubeOfCrouch, IsProportionalToTheSizes) {
  Disturbances sizes = default_disturbances(problem_.robot);
  const Tube whole = tube(sizes);
  for (double* size : {&sizes.base_position, &sizes.base_angle, &sizes.base_velocity, &sizes.base_rate, &sizes.mass,
                       &sizes.center, &sizes.push})
    *size *= 0.5;
  const Tube half = tube(sizes);
  const auto& a = whole.phases.front().needed;
  const auto& b = half.phases.front().needed;
  EXPECT_LT((a.cone - 2.0 * b.cone).norm(), 1e-2 * a.cone.norm());
  EXPECT_LT((a.torque - 2.0 * b.torque).norm(), 1e-2 * a.torque.norm());
}

/// Two standard deviations of what is drawn, and the worst push, as squares.
TEST_F(TubeOfCrouch, HasABandOfDrawsAndPush) {
  const Tube::OfPhase drawn = tube({.base_position = 0.005, .mass = 0.1}).phases.front();
  EXPECT_LT((drawn.band() - 2.0 * drawn.state).norm(), 1e-12 * drawn.state.norm());
  const Tube::OfPhase pushed = tube({.push = 0.1}).phases.front();
  EXPECT_LT((pushed.band() - pushed.pushed).norm(), 1e-12 * pushed.pushed.norm());
  const Tube::OfPhase both = tube({.base_position = 0.005, .mass = 0.1, .push = 0.1}).phases.front();
  const Eigen::MatrixXd squares = drawn.band().cwiseAbs2() + pushed.band().cwiseAbs2();
  EXPECT_LT((both.band().cwiseAbs2() - squares).norm(), 1e-9 * squares.norm());
}

/// A push moves the base by about impulse / mass times its duration, then feedback brings it back.
TEST_F(TubeOfCrouch, OfAPushIsThatOfItsVelocity) {
  const Tube::OfPhase phase = tube({.push = 0.1}).phases.front();
  const Eigen::Index nv = problem_.robot.nv();
  EXPECT_GT(phase.pushed.row(nv).maxCoeff(), 0.04);
  EXPECT_LT(phase.pushed.row(nv).maxCoeff(), 0.1) << "the feedback acts during the push";
  EXPECT_EQ(phase.state.norm(), 0.0);
}

}  // namespace
}  // namespace prowl
