// The tube of HyQ's crouch against rollouts of its closed loop, which are not linear.
#include "prowl/robust/tube.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
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
    return make_tube(problem_, solved_.trajectory, solved_.task.tracking, sizes);
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
  for (const DisturbanceKey& key : kDisturbanceKeys)
    if (key.size != &Disturbances::push_duration) sizes.*key.size *= 0.5;
  const Tube half = tube(sizes);
  const auto& a = whole.phases.front().needed;
  const auto& b = half.phases.front().needed;
  constexpr double kSquares = 1e-6;  // inertia about the origin has the square of the centre's error
  EXPECT_LT((a.cone - 2.0 * b.cone).norm(), kSquares * a.cone.norm());
  EXPECT_LT((a.torque - 2.0 * b.torque).norm(), kSquares * a.torque.norm());
  EXPECT_LT((a.joint - 2.0 * b.joint).norm(), kSquares * a.joint.norm());
  const Eigen::MatrixXd friction = whole.phases.front().friction;
  EXPECT_GT(friction.minCoeff(), 0.0);
  EXPECT_LT((friction - 2.0 * half.phases.front().friction).norm(), 1e-2 * friction.norm())
      << "the cone's tip is round";
}

/// A robot that holds its posture holds the estimate there: the true base is off by the error, the other way, and by
/// what gravity adds while legs give way.
TEST_F(TubeOfCrouch, AWrongEstimateMovesTheBaseByItsError) {
  const Tube::OfPhase phase = tube({.estimate_position = 0.01}).phases.back();
  EXPECT_LT(tube({.estimate_position = 0.01}).phases.front().state.col(0).norm(), 1e-12) << "it takes time";
  const Eigen::VectorXd at_end = phase.state.rightCols(1);
  const double error = 0.01 / std::sqrt(3.0);
  for (int axis = 0; axis < 2; ++axis) {
    EXPECT_GT(at_end(axis), error) << axis;
    EXPECT_LT(at_end(axis), 1.5 * error) << axis;
  }
  EXPECT_NEAR(at_end(2), error, 0.1 * error) << "no lever";
}

/// Legs reach for ground that is higher or lower; the base stays.
TEST_F(TubeOfCrouch, LegsFollowTheGround) {
  const double height = 0.01;  // two standard deviations
  const Tube::OfPhase phase = tube({.ground = height}).phases.front();
  const Eigen::VectorXd off = phase.state.col(0);
  EXPECT_EQ(off.head<6>().norm(), 0.0);
  RigidBodyTerms terms(problem_.robot);
  terms.update_kinematics(solved_.trajectory.nodes.front().q);
  ContactKinematics foot({0});
  foot.set_configuration(terms);
  const Eigen::Matrix3d leg = foot.positions_dq().middleCols<3>(6);  // of lf_foot, whose joints are the first
  const Eigen::Vector3d expected = leg.lu().solve(Eigen::Vector3d(0.0, 0.0, 0.5 * height)).cwiseAbs();
  EXPECT_LT((off.segment<3>(6) - expected).norm(), 0.03 * expected.norm()) << "damped";
}

/// What is drawn by itself adds its variance.
TEST_F(TubeOfCrouch, HasABandOfTwoStandardDeviations) {
  const Tube::OfPhase drawn = tube({.base_position = 0.005, .mass = 0.1}).phases.front();
  EXPECT_EQ((drawn.band() - 2.0 * drawn.state).norm(), 0.0);
  const Tube::OfPhase pushed = tube({.push = 0.1}).phases.front();
  const Tube::OfPhase both = tube({.base_position = 0.005, .mass = 0.1, .push = 0.1}).phases.front();
  const Eigen::MatrixXd squares = drawn.state.cwiseAbs2() + pushed.state.cwiseAbs2();
  EXPECT_LT((both.state.cwiseAbs2() - squares).norm(), 1e-9 * squares.norm());
}

/// Of those that began long before, feedback has taken most; of those to come there is nothing yet.
TEST_F(TubeOfCrouch, OfAPushIsThatOfItsVelocity) {
  const double velocity = 0.1, share = 1.0 / std::sqrt(2.0);  // along one of two axes
  const Tube::OfPhase phase = tube({.push = velocity}).phases.front();
  const auto vx = phase.state.row(problem_.robot.nv());
  EXPECT_EQ(vx(0), 0.0);
  EXPECT_GT(vx.maxCoeff(), 0.1 * share * velocity);
  EXPECT_LT(vx.maxCoeff(), share * velocity);
}

/// A short push gives its impulse on any grid.
TEST_F(TubeOfCrouch, OfAPushDoesNotDependOnTheStep) {
  const Disturbances sizes{.push = 0.1, .push_duration = 0.025};
  const auto state = [&](double step) {
    return make_tube(problem_, solved_.trajectory, solved_.task.tracking, sizes, step).phases.front().state;
  };
  const Eigen::MatrixXd fine = state(solved_.task.tracking.step), rough = state(kTubeStep);
  for (const Eigen::Index row : {Eigen::Index{0}, Eigen::Index{problem_.robot.nv()}})
    EXPECT_NEAR(rough.row(row).maxCoeff(), fine.row(row).maxCoeff(), 0.05 * fine.row(row).maxCoeff()) << row;
}

}  // namespace
}  // namespace prowl
