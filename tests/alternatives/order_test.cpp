#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/given_torques.hpp"

// How fast what a rule makes of given torques goes to the true motion.

namespace prowl {
namespace {

using test::end_of_given_motion;
using test::state_error;
using test::StateError;

void expect_order(double order, const Formulation& formulation, const TrajectoryPoint& truth) {
  const StateError coarse = state_error(end_of_given_motion(formulation, 8), truth);
  const StateError fine = state_error(end_of_given_motion(formulation, 16), truth);
  SCOPED_TRACE(formulation.dynamics + ", " + formulation.transcription);
  EXPECT_NEAR(std::log2(coarse.q / fine.q), order, 0.35) << coarse.q << " -> " << fine.q;
  EXPECT_NEAR(std::log2(coarse.v / fine.v), order, 0.35) << coarse.v << " -> " << fine.v;
}

TEST(Order, TrapezoidIsOfOrderTwoHermiteSimpsonAndRungeKuttaOfOrderFour) {
  const TrajectoryPoint truth = end_of_given_motion({.transcription = "hermite-simpson"}, 128);
  const MotionProblem problem = test::given_motion(1).problem;
  const Eigen::VectorXd at_rest = Eigen::VectorXd::Zero(problem.robot.nv());
  EXPECT_GT(state_error(truth, {.q = problem.start_configuration(), .v = at_rest}).q, 0.02) << "nothing moves";
  expect_order(2.0, {}, truth);
  expect_order(2.0, {.dynamics = "forward"}, truth);
  for (const std::string dynamics : {"inverse", "forward", "kkt"}) {
    expect_order(4.0, {.dynamics = dynamics, .transcription = "hermite-simpson"}, truth);
  }
  expect_order(4.0, {.transcription = "hermite-simpson-separated"}, truth);
  expect_order(4.0, {.dynamics = "forward", .transcription = "rk4"}, truth);
}

}  // namespace
}  // namespace prowl
