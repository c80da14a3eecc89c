#include "prowl/mpc/plan_executor.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <limits>
#include <thread>

#include "tests/support/allocations.hpp"
#include "tests/support/robots.hpp"

namespace prowl {
namespace {

using Eigen::VectorXd;

/// A plan that begins at `start` and asks each joint for a torque of `tau`.
MpcPlan plan_of(const RobotModel& robot, double start, double tau) {
  MpcPlan plan(robot, 3);
  for (std::size_t k = 0; k < 3; ++k) {
    plan.steps()[k].start = start + 0.1 * static_cast<double>(k);
    plan.steps()[k].length = 0.1;
    plan.steps()[k].tau.setConstant(tau);
  }
  return plan;
}

struct Executed {
  RobotModel robot{test::hyq_description()};
  VectorXd q = robot.nominal_configuration(), v = VectorXd::Zero(robot.nv()), tau = VectorXd::Zero(robot.nu());
  PlanExecutor executor{robot, plan_of(robot, 0.0, 1.0)};
  double torque(double t) {
    executor.torque(t, q, v, tau);
    return tau(0);
  }
};

TEST(PlanExecutor, APlanActsFromItsStart) {
  Executed one;
  EXPECT_EQ(one.torque(0.0), 1.0);
  one.executor.offer(plan_of(one.robot, 0.05, 2.0));
  EXPECT_EQ(one.torque(0.04), 1.0);
  EXPECT_EQ(one.torque(0.05), 2.0);
  one.executor.offer(plan_of(one.robot, 0.2, 3.0));
  one.executor.offer(plan_of(one.robot, 0.1, 4.0));
  EXPECT_EQ(one.torque(0.15), 4.0) << "the latest one replaces one that has not begun";
}

/// A fast computer: the next plan is offered before the last one begins.
TEST(PlanExecutor, PlansThatComeEarlyActOneAfterTheOther) {
  Executed one;
  for (int tick = 0; tick < 500; ++tick) {
    const double t = 1e-3 * tick;
    if (tick % 10 == 1) one.executor.offer(plan_of(one.robot, t - 1e-3 + 0.012, 2.0 + tick / 10));
    if (tick >= 12) EXPECT_EQ(one.torque(t), 2.0 + (tick - 12) / 10) << tick;
  }
}

TEST(PlanExecutor, DampsJointsAfterTheEndOfAPlan) {
  Executed one;
  one.v.setOnes();
  EXPECT_LT(one.torque(0.5), 0.0);
  one.v(6) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(one.torque(0.5), 0.0);
}

TEST(PlanExecutor, FeedbackIsThatOfItsPlans) {
  Executed one;
  for (const double most_feedback : {0.05, 0.5}) {
    MpcPlan plan(one.robot, 2, most_feedback);
    for (MpcPlan::Step& step : plan.steps()) step.gain.setConstant(1e4);
    PlanExecutor executor(one.robot, plan);
    VectorXd expected;
    one.q(8) = one.robot.nominal_configuration()(8) + 0.1;
    plan.torque(0.0, one.q, one.v, expected);
    executor.torque(0.0, one.q, one.v, one.tau);
    EXPECT_EQ(one.tau, expected);
    EXPECT_NEAR(one.tau(0), most_feedback * one.robot.torque_limit()(0), 1e-9);
  }
}

TEST(PlanExecutor, NeverMixesTwoPlans) {
  Executed one;
  std::atomic<bool> done = false;
  std::thread planner([&] {
    for (int i = 1; i < 2000; ++i) one.executor.offer(plan_of(one.robot, 0.0, i));
    done = true;
  });
  double before = 0.0;
  for (bool is_last = false; !is_last;) {
    is_last = done;
    const double now = one.torque(0.1);
    EXPECT_TRUE((one.tau.array() == now).all());
    EXPECT_GE(now, before);
    before = now;
  }
  planner.join();
  EXPECT_GT(one.torque(0.1), 1.0) << "plans were offered";
}

#ifdef PROWL_COUNTS_ALLOCATIONS
TEST(PlanExecutor, AllocatesNothing) {
  Executed one;
  const MpcPlan next = plan_of(one.robot, 0.05, 2.0);
  const long before = test::allocations;
  one.torque(0.0);
  one.executor.offer(next);
  one.torque(0.06);
  one.torque(9.0);
  EXPECT_EQ(test::allocations, before);
}
#endif

}  // namespace
}  // namespace prowl
