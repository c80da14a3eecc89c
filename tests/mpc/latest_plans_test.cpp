#include "prowl/mpc/latest_plans.hpp"

#include <gtest/gtest.h>

#include "tests/support/robots.hpp"

namespace prowl {
namespace {

using Eigen::VectorXd;

struct Plans {
  RobotModel robot{test::hyq_description()};
  LatestPlans plans{robot, MpcPlan(robot, 1)};
  VectorXd q = robot.nominal_configuration(), v = VectorXd::Zero(robot.nv()), tau = VectorXd::Zero(robot.nu());

  Plans() { add(0.0, 1.0); }
  /// A plan that begins at `start`, takes 0.1 s and asks each joint for a torque of `tau`.
  void add(double start, double of_joints) {
    MpcPlan::Step& step = plans.begin_next().steps().front();
    step.start = start;
    step.length = 0.1;
    step.tau.setConstant(of_joints);
  }
  double torque(double t) {
    plans.torque(t, q, v, tau);
    return tau(0);
  }
};

TEST(LatestPlans, TheOneBeforeGoesOnUntilTheLatestBegins) {
  Plans two;
  two.add(0.05, 2.0);
  EXPECT_EQ(two.torque(0.04), 1.0);
  EXPECT_EQ(two.torque(0.05), 2.0);
}

TEST(LatestPlans, APlanActsWhenItIsReady) {
  Plans two;
  two.add(0.05, 2.0);
  two.plans.act_from(0.07);
  EXPECT_EQ(two.torque(0.06), 1.0);
  EXPECT_EQ(two.torque(0.07), 2.0);
  two.add(0.08, 3.0);
  EXPECT_EQ(two.torque(0.08), 3.0) << "only the latest had to wait";
}

TEST(LatestPlans, ADroppedPlanNeverActs) {
  Plans two;
  two.add(0.05, 2.0);
  two.plans.drop_latest();
  EXPECT_EQ(two.torque(0.06), 1.0);
  EXPECT_EQ(two.plans.latest().start(), 0.05) << "the next plan starts from it";
  two.add(0.06, 3.0);
  EXPECT_EQ(two.torque(0.06), 3.0);
}

/// As after the construction of a controller, whose first plans begin all at once.
TEST(LatestPlans, ADroppedPlanDoesNotActBeforeItsStartEither) {
  Plans all;
  for (int k = 0; k <= LatestPlans::kLongestDelay; ++k) all.add(0.05, 2.0);
  all.add(0.05, 3.0);
  all.plans.drop_latest();
  EXPECT_EQ(all.torque(0.04), 2.0);
}

TEST(LatestPlans, TheOneBeforeManyDroppedPlansGoesOn) {
  Plans many;
  for (int k = 1; k < 3 * LatestPlans::kLongestDelay; ++k) {
    many.add(1e-3 * k, 2.0);
    many.plans.drop_latest();
  }
  EXPECT_EQ(many.torque(0.09), 1.0);
}

/// A plan every 10 ms that begins 12 ms after it was made. Sums of times differ in their last bits.
TEST(LatestPlans, TheNewestThatHasBegunActsAtEachTick) {
  Plans run;
  for (int tick = 0; tick < 3000; ++tick) {
    const double t = 1e-3 * tick;
    if (tick % 10 == 0) run.add(t + 0.012, 2.0 + tick / 10 % 100);
    const int begun = (tick + 2 - 12) / 10;
    if (tick >= 10) EXPECT_EQ(run.torque(t + 1e-3 + 1e-3), 2.0 + begun % 100) << tick;
  }
}

TEST(LatestPlans, TheLongestDelayIsCovered) {
  constexpr int kDelay = LatestPlans::kLongestDelay;
  Plans run;
  for (int k = 0; k < 20; ++k) {
    run.add(0.01 * (k + kDelay), 2.0 + k);
    if (k >= kDelay) EXPECT_EQ(run.torque(0.01 * k), 2.0 + k - kDelay) << k;
  }
}

TEST(LatestPlans, DampsJointsAfterTheEnd) {
  Plans one;
  one.v.setOnes();
  EXPECT_FALSE(one.plans.torque(0.5, one.q, one.v, one.tau));
  EXPECT_TRUE((one.tau.array() <= 0.0).all());
}

}  // namespace
}  // namespace prowl
