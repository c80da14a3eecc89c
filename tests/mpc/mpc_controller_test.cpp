#include "prowl/mpc/mpc_controller.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "prowl/error.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/mpc/stepping_patterns.hpp"
#include "tests/support/allocations.hpp"
#include "tests/support/robots.hpp"

namespace prowl {
namespace {

using Eigen::VectorXd;

struct Standing {
  explicit Standing(const RobotDescription& description = test::hyq_description(), const MpcOptions& options = {})
      : robot(description),
        q(HorizonProgram(robot, MpcWeights{}, 0.6, 2).standing_posture()),
        v(VectorXd::Zero(robot.nv())),
        mpc(robot, options, q, v, 0.0) {}
  void trot() { follow("trot"); }
  /// Of so many updates from (q, v), 10 ms apart, after time t [s].
  int failures(int updates, double& t) {
    int count = 0;
    for (int i = 0; i < updates; ++i) count += mpc.update(q, v, t += 0.01) ? 0 : 1;
    return count;
  }
  void follow(const std::string& gait) { mpc.follow(stepping_pattern(robot, mpc.feet(), q.z(), gait)); }

  RobotModel robot;
  VectorXd q, v;
  MpcController mpc;
};

TEST(MpcController, StandingIsASolution) {
  Standing standing;
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(standing.mpc.update(standing.q, standing.v, 0.0));
  EXPECT_LT(standing.mpc.solver().violation(), 1e-9);
  double lift = 0.0;
  const MpcPlan::Step& first = standing.mpc.latest().steps().front();
  for (Eigen::Index i = 2; i < first.force.size(); i += 3) lift += first.force(i);
  EXPECT_NEAR(lift / standing.robot.weight(), 1.0, 0.01);
}

/// The robot follows its plan exactly, for a while.
void follow_plan(Standing& standing, double from, double to) {
  constexpr double kPeriod = 0.01;
  for (double t = from; t < to - 1e-9; t += kPeriod) {
    standing.mpc.latest().state(t, standing.q, standing.v);
    ASSERT_TRUE(standing.mpc.update(standing.q, standing.v, t)) << t;
  }
}

TEST(MpcController, PlansStepsThatItCanFollow) {
  Standing standing;
  standing.trot();
  MpcCommand command;
  command.forward = 0.3;
  standing.mpc.command(command);
  const double before = standing.q.x();
  follow_plan(standing, 0.0, 4.0);
  EXPECT_EQ(standing.mpc.counters().failed, 0);
  EXPECT_NEAR(standing.mpc.followed().forward, 0.3, 1e-12);
  EXPECT_GT(standing.q.x() - before, 0.6);
  EXPECT_NEAR(standing.q.z(), standing.mpc.standing_posture().z(), 0.1) << "without ground the feet press lower";
  // Hard limits hold in the plan, as well as quadratic programs are solved.
  const double unsolved = HorizonSolver::kTolerance * standing.robot.weight() * standing.robot.size();  // [N m]
  for (const MpcPlan::Step& step : standing.mpc.latest().steps())
    EXPECT_TRUE((step.tau.cwiseAbs().array() <= standing.robot.torque_limit().array() + unsolved).all());
}

/// A leg that pushes hard before its foot has touched is thrown at the ground, and bounces.
TEST(MpcController, LoadsLandingFeetLittleByLittle) {
  Standing standing;
  standing.trot();
  constexpr double kPeriod = 0.01, kSoon = 0.03;  // [s]
  int landings = 0;
  for (double t = 0.0; t < 3.0; t += kPeriod) {
    const std::vector<MpcPlan::Step>& steps = standing.mpc.latest().steps();
    for (std::size_t k = 1; k < steps.size(); ++k) {
      if (steps[k].start + 0.5 * steps[k].length > t + 0.2) break;  // later steps are solved less well
      for (int foot = 0; foot < 4; ++foot) {
        const bool lands = ((steps[k].standing & ~steps[k - 1].standing) >> foot & 1U) != 0;
        if (!lands || steps[k].length > kSoon) continue;
        ++landings;
        EXPECT_LT(steps[k].force(3 * foot + 2), 0.4 * standing.robot.weight()) << t << ", foot " << foot;
      }
    }
    follow_plan(standing, t, t + kPeriod);
  }
  EXPECT_GT(landings, 50);
}

TEST(MpcController, GainsAreTheDerivativeOfThePlannedTorque) {
  Standing standing;
  // With one iteration the quadratic program is Newton's step, linear in the measured state.
  MpcOptions options;
  options.iterations = options.feedback_iterations = 1;
  MpcController once(standing.robot, options, standing.q, standing.v, 0.0);
  const int nv = standing.robot.nv();
  constexpr double kMoved = 1e-4;
  for (int i = 0; i < 2 * nv; ++i) {
    for (int settling = 0; settling < 20; ++settling) ASSERT_TRUE(once.update(standing.q, standing.v, 0.0));
    const VectorXd tau = once.latest().steps()[0].tau, gain = once.latest().steps()[0].gain.col(i);
    VectorXd q = standing.q, v = standing.v;
    if (i < 3) q(i) += kMoved;  // the base moves along the world's axes
    if (i >= 3 && i < nv) q = integrate(q, kMoved * VectorXd::Unit(nv, i));
    if (i >= nv) v(i - nv) += kMoved;
    ASSERT_TRUE(once.update(q, v, 0.0));
    const VectorXd changed = once.latest().steps()[0].tau - tau;
    EXPECT_LT((changed - kMoved * gain).norm(), 1e-2 * kMoved * gain.norm() + 1e-6) << i;
  }
}

TEST(MpcController, RefusesOptionsOutOfRange) {
  Standing standing;
  const auto refuses = [&](const MpcOptions& options) {
    EXPECT_THROW(MpcController(standing.robot, options, standing.q, standing.v, 0.0), InputError);
  };
  refuses({.steps = 1});
  refuses({.clearance = 0.0});
  refuses({.clearance = std::numeric_limits<double>::infinity()});
  refuses({.delay = 1e6});
  refuses({.delay = std::numeric_limits<double>::quiet_NaN()});
  refuses({.iterations = 0});
  refuses({.feedback_iterations = 0});
  refuses({.weights = {.torque = -0.1}});
  refuses({.weights = {.force = std::numeric_limits<double>::quiet_NaN()}});
  refuses({.weights = {.penalty = 0.0}});
}

TEST(MpcController, FitsOptionsToRobotAndDelay) {
  const MpcOptions shipped, of_biped = options_for(RobotModel(test::talos_description()), {.delay = 0.042});
  EXPECT_EQ(of_biped.steps, shipped.steps_of_biped);
  EXPECT_EQ(of_biped.clearance, shipped.clearance_of_biped);
  EXPECT_EQ(of_biped.weights.posture, shipped.weights.posture_of_biped);
  EXPECT_EQ(of_biped.first_step, 0.042);
  const MpcOptions of_quadruped = options_for(RobotModel(test::hyq_description()), {.delay = 0.012});
  EXPECT_EQ(of_quadruped.steps, shipped.steps);
  EXPECT_EQ(of_quadruped.clearance, shipped.clearance);
  EXPECT_EQ(of_quadruped.weights.posture, shipped.weights.posture);
  EXPECT_EQ(of_quadruped.first_step, shipped.first_step);
}

TEST(MpcController, SurvivesStatesThatAreNone) {
  Standing standing;
  standing.trot();
  follow_plan(standing, 0.0, 0.5);
  VectorXd nan = standing.q, tau;
  nan(8) = std::numeric_limits<double>::quiet_NaN();
  const double planned_until = standing.mpc.latest().end();
  for (double t = 0.5; t < planned_until + 0.5; t += 0.01) {
    EXPECT_FALSE(standing.mpc.update(nan, standing.v, t));
    standing.mpc.torque(t, nan, standing.v, tau);
    EXPECT_TRUE(tau.allFinite()) << t;
    standing.mpc.torque(t, standing.q, standing.v, tau);
    EXPECT_TRUE(tau.allFinite()) << t;
  }
  EXPECT_GT(standing.mpc.counters().bad_states, 50);
  EXPECT_GT(standing.mpc.counters().damped, 0) << "after its end a plan does not go on";
  // And it recovers.
  double t = planned_until + 0.5;
  standing.q = standing.mpc.standing_posture();
  standing.v.setZero();
  int last_failure = -1;
  for (int i = 0; i < 50; ++i, t += 0.01) {
    if (!standing.mpc.update(standing.q, standing.v, t)) last_failure = i;
  }
  EXPECT_LT(last_failure, 30) << "of 50 updates";
}

/// Such as a velocity over two equal time stamps.
TEST(MpcController, RecoversFromStatesAndTimesThatNoRobotReaches) {
  Standing standing(test::hyq_description(), {.delay = 0.012});
  double t = 0.0;
  VectorXd tau;
  for (const double wild : {1e3, 1e6, 1e20, 1e160}) {
    for (const int i : {0, 3, 9}) {
      VectorXd q = standing.q, v = standing.v;
      v(i) = wild;
      EXPECT_FALSE(standing.mpc.update(q, v, t += 0.01)) << i << ' ' << wild;
      standing.mpc.torque(t, q, v, tau);
      EXPECT_TRUE(tau.allFinite()) << i << ' ' << wild;
      q(i) = wild;
      standing.mpc.update(q, standing.v, t += 0.01);
      standing.mpc.torque(t, q, standing.v, tau);
      EXPECT_TRUE(tau.allFinite()) << i << ' ' << wild;
      EXPECT_LT(standing.failures(30, t), 10) << i << ' ' << wild;
    }
  }
  for (const double time : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
    EXPECT_FALSE(standing.mpc.update(standing.q, standing.v, time));
  EXPECT_EQ(standing.failures(30, t), 0);
}

/// However wild, if it takes them for states.
TEST(MpcController, RecoversFromRandomStates) {
  Standing standing(test::hyq_description(), {.delay = 0.012});
  standing.trot();
  std::mt19937 rng(5);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0), decades(-1.0, 2.5);
  VectorXd tau;
  double t = 0.0;
  for (int repeat = 0; repeat < 15; ++repeat) {
    for (int wild = 0; wild < 7; ++wild) {
      VectorXd q = standing.q, v = standing.v;
      const double size = std::pow(10.0, decades(rng));
      for (Eigen::Index i = 0; i < v.size(); ++i) v(i) = 0.1 * size * uniform(rng);
      for (Eigen::Index i = 7; i < q.size(); ++i) q(i) += size * uniform(rng);
      standing.mpc.update(q, v, t += 0.01);
      standing.mpc.torque(t, q, v, tau);
      EXPECT_TRUE(tau.allFinite()) << repeat;
    }
    EXPECT_LT(standing.failures(30, t), 20) << repeat;
  }
}

TEST(MpcController, FeelsNothingAtTimesThatAreNone) {
  Standing standing(test::hyq_description(), {.delay = 0.012});
  standing.follow("trot");
  standing.mpc.update(standing.q, standing.v, 0.0);
  const std::vector<bool> touches(4, true);
  for (const double time : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
    standing.mpc.feel_contacts(touches, time);
  for (double t = 0.0; t < 0.6; t += 0.01) {
    for (int foot = 0; foot < 4; ++foot) {
      if (const auto* const swing = standing.mpc.timeline().swing(foot, t)) EXPECT_FALSE(swing->has_touched) << t;
    }
  }
}

TEST(MpcController, BeginsAnewAfterALongPause) {
  Standing standing;
  standing.trot();
  follow_plan(standing, 0.0, 0.5);
  double t = 1e7;  // a clock that was set, while the robot was in the middle of a stride
  standing.v.setZero();
  EXPECT_LT(standing.failures(50, t), 20);
}

/// Without new plans the next program still begins with the multipliers of its own times.
TEST(MpcController, KeepsWhatItKnowsOfLimitsWhileStatesAreMissing) {
  Standing standing;
  standing.trot();
  follow_plan(standing, 0.0, 1.0);
  VectorXd nan = standing.q;
  nan(8) = std::numeric_limits<double>::quiet_NaN();
  constexpr int kUpdates = 15;
  int iterations = 0;
  for (int i = 0; i < kUpdates; ++i) {
    const double t = 1.0 + 0.01 * i;
    ASSERT_TRUE(standing.mpc.prepare(t));
    iterations += standing.mpc.solver().iterations();
    EXPECT_FALSE(standing.mpc.plan(nan, standing.v, t));
  }
  EXPECT_LT(iterations, 4 * kUpdates);
}

TEST(MpcController, ClampsCommandsToWhatTheLegsAllow) {
  Standing standing;
  EXPECT_EQ(standing.mpc.command({.forward = 0.3}), MpcCommand{}) << "it stands";
  standing.trot();
  MpcCommand command;
  command.forward = 100.0;
  command.turn = -100.0;
  command.left = std::numeric_limits<double>::quiet_NaN();
  const MpcCommand followed = standing.mpc.command(command);
  EXPECT_GT(followed.forward, 0.5);
  EXPECT_LT(followed.forward, 3.0);
  EXPECT_LT(followed.turn, -0.5);
  EXPECT_GT(followed.turn, -3.0);
  EXPECT_EQ(followed.left, 0.0);
}

TEST(MpcController, RefusesAGaitWithoutTheFeetForIt) {
  const RobotModel talos(test::talos_description());
  EXPECT_THROW(stepping_pattern(talos, contacts_of_feet(talos), 1.0, "trot"), InputError);
  EXPECT_THROW(stepping_pattern(talos, contacts_of_feet(talos), 1.0, "jig"), InputError);
  EXPECT_EQ(stepping_pattern(talos, contacts_of_feet(talos), 1.0, "walk").groups.size(), 2U);
}

#ifdef PROWL_COUNTS_ALLOCATIONS
class AllocatesNothing : public testing::TestWithParam<RobotDescription (*)()> {};

TEST_P(AllocatesNothing, OnceItRuns) {
  Standing standing(GetParam()(), {.delay = 0.012});
  standing.follow("walk");
  follow_plan(standing, 0.0, 2.0);  // all sets of contacts of the gait have been
  VectorXd tau(standing.robot.nu());
  std::vector<bool> touches(standing.mpc.feet().size());
  long allocated = 0;
  int most_iterations = 0;
  for (double t = 2.0; t < 3.0; t += 0.01) {
    standing.mpc.latest().state(t, standing.q, standing.v);
    standing.v(1) += 0.01 * std::sin(300.0 * t);
    touches.assign(touches.size(), t < 2.3);  // then all are lost
    const long before = test::allocations;
    standing.mpc.feel_contacts(touches, t);
    standing.mpc.update(standing.q, standing.v, t);
    standing.mpc.torque(t, standing.q, standing.v, tau);
    allocated += test::allocations - before;
    most_iterations = std::max(most_iterations, standing.mpc.solver().iterations());
  }
  EXPECT_EQ(allocated, 0);
  EXPECT_GT(most_iterations, 1) << "of feedback";
}

INSTANTIATE_TEST_SUITE_P(MpcController, AllocatesNothing,
                         testing::Values(&test::hyq_description, &test::talos_description));
#endif

}  // namespace
}  // namespace prowl
