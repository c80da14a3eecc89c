#include "prowl/mpc/mpc_plan.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "prowl/model/configuration.hpp"
#include "tests/support/random_vector.hpp"
#include "tests/support/robots.hpp"

namespace prowl {
namespace {

using Eigen::VectorXd;

class Plan : public testing::Test {
 protected:
  Plan() : robot(test::hyq_description()), plan(robot, 2), rng(7) {
    double start = 1.0;
    for (MpcPlan::Step& step : plan.steps()) {
      step.start = start;
      step.length = 0.02;
      step.q = integrate(robot.nominal_configuration(), test::random_vector(rng, robot.nv(), 0.1));
      step.v = test::random_vector(rng, robot.nv(), 0.3);
      step.a = test::random_vector(rng, robot.nv(), 1.0);
      step.tau = test::random_vector(rng, robot.nu(), 5.0);
      step.gain = Eigen::MatrixXd::Random(robot.nu(), 2 * robot.nv());
      start += step.length;
    }
  }
  RobotModel robot;
  MpcPlan plan;
  std::mt19937 rng;
};

TEST_F(Plan, OnThePlanItsTorqueActs) {
  VectorXd q = plan.steps()[0].q, v, tau;
  for (const double t : {1.0, 1.013, 1.02, 1.031}) {
    plan.state(t, q, v);
    plan.torque(t, q, v, tau);
    EXPECT_LT((tau - plan.step_at(t).tau).norm(), 1e-9) << t;
  }
}

TEST_F(Plan, GainsMultiplyTheDeviation) {
  VectorXd q = plan.steps()[0].q, v, tau;
  plan.state(1.005, q, v);
  const VectorXd dq = test::random_vector(rng, robot.nv(), 1e-3), dv = test::random_vector(rng, robot.nv(), 1e-3);
  plan.torque(1.005, integrate(q, dq), v + dv, tau);
  VectorXd deviation(2 * robot.nv());
  deviation << dq, dv;
  EXPECT_LT((tau - plan.steps()[0].tau - plan.steps()[0].gain * deviation).norm(), 1e-9);
}

/// Gains that are right near the plan throw the robot over far from it.
TEST_F(Plan, FeedbackFarFromThePlanIsBounded) {
  VectorXd q = plan.steps()[0].q, v, tau;
  plan.state(1.005, q, v);
  v += 10.0 * VectorXd::Ones(robot.nv());
  plan.torque(1.005, q, v, tau);
  const VectorXd feedback = (tau - plan.steps()[0].tau).cwiseAbs();
  EXPECT_TRUE((feedback.array() <= 0.2 * robot.torque_limit().array() + 1e-9).all()) << feedback.transpose();
  EXPECT_GT(feedback.maxCoeff(), 0.19 * robot.torque_limit().minCoeff());
}

TEST_F(Plan, VelocityIsTheRateOfTheState) {
  constexpr double kStep = 1e-6;
  VectorXd before = plan.steps()[0].q, after = before, q = before, v, ignored;
  const double t = 1.0 + kStep;  // near the start: inside a step the rule is that of its middle
  plan.state(t - kStep, before, ignored);
  plan.state(t + kStep, after, ignored);
  plan.state(t, q, v);
  VectorXd rate = difference(before, after) / (2.0 * kStep);
  rate.head<3>() = base_rotation(q).transpose() * rate.head<3>();
  EXPECT_LT((rate - v).norm(), 1e-5);
}

TEST_F(Plan, TorquesAreFiniteAndWithinTheLimitsWhateverTheState) {
  VectorXd q = plan.steps()[0].q, v = plan.steps()[0].v, tau;
  plan.torque(1.0, q, 1e6 * VectorXd::Ones(robot.nv()), tau);
  EXPECT_TRUE((tau.cwiseAbs().array() <= robot.torque_limit().array()).all());
  v(3) = std::numeric_limits<double>::quiet_NaN();
  plan.torque(1.0, q, v, tau);
  EXPECT_EQ(tau, plan.steps()[0].tau);
  plan.steps()[0].tau *= 1e4;
  plan.torque(1.0, q, v, tau);
  EXPECT_TRUE((tau.cwiseAbs().array() <= robot.torque_limit().array()).all()) << "nothing is known of the state";
}

}  // namespace
}  // namespace prowl
