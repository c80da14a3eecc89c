#include "prowl/feasibility/standing_load.hpp"

#include <gtest/gtest.h>

#include "prowl/dynamics/static_equilibrium.hpp"
#include "prowl/solvers/foreign/ipopt_solver.hpp"
#include "tests/support/standing_problem.hpp"

namespace prowl {
namespace {

StandingLoad load_of(const MotionProblem& problem) {
  return standing_load(problem, problem.start_configuration(), problem.phases[0].contacts, IpoptSolver());
}

TEST(StandingLoad, IsAllOfTheWeightInTheNominalPosture) {
  for (const RobotModel& robot : {test::hyq(), test::anymal_c(), test::solo12(), test::go2()}) {
    for (const double slope : {0.0, 15.0}) {
      const StandingLoad load = load_of(test::standing_problem(robot, slope, 0.5));
      EXPECT_TRUE(load.solved) << robot.name();
      EXPECT_NEAR(load.share, 1.0, 1e-4) << robot.name() << ", slope " << slope;
    }
  }
  EXPECT_NEAR(load_of(test::standing_problem(test::talos())).share, 1.0, 1e-4);
  EXPECT_NEAR(load_of(test::standing_problem(test::talos(), 15.0)).share, 0.0, 1e-4)
      << "it does not lean, and falls back";
}

TEST(StandingLoad, IsNothingWhereTheContactsCannotBalance) {
  EXPECT_NEAR(load_of(test::standing_problem(test::hyq(), 30.0, 0.5)).share, 0.0, 1e-4) << "friction";
  MotionProblem two_left = test::standing_problem();
  two_left.phases[0].contacts = {{0, 0}, {1, 0}};
  EXPECT_NEAR(load_of(two_left).share, 0.0, 1e-4) << "it falls over to the right";
}

// A pyramid of 16 edges is up to 2 % wider than the cone, not narrower: tan 15 = 0.2679.
TEST(StandingLoad, FindsTheFrictionThatASlopeNeeds) {
  EXPECT_NEAR(load_of(test::standing_problem(test::hyq(), 15.0, 0.2685)).share, 1.0, 1e-4);
  EXPECT_NEAR(load_of(test::standing_problem(test::hyq(), 15.0, 0.25)).share, 0.0, 1e-4);
}

TEST(StandingLoad, SaysWhichTorqueIsMissing) {
  RobotDescription description = test::hyq_description();
  for (const char* leg : {"lf", "lh", "rf", "rh"}) description.limits[std::string(leg) + "_kfe_joint"].torque = 15.0;
  const MotionProblem problem = test::standing_problem(RobotModel(description));
  const StandingLoad load = load_of(problem);
  ASSERT_TRUE(load.solved);
  EXPECT_LT(load.share, 0.9);
  EXPECT_GT(load.share, 0.1);
  const Eigen::VectorXd& limit = problem.robot.torque_limit();
  const double most = (load.share * load.torque_needed).cwiseAbs().cwiseQuotient(limit).maxCoeff();
  EXPECT_NEAR(most, 1.0, 1e-4) << "some joint is at its limit, none above it";
  // All other forces need as much of the worst joint, or more; those of least norm, say.
  const StaticEquilibrium other = static_equilibrium(problem.robot, problem.start_configuration(), {0, 1, 2, 3});
  EXPECT_GE(other.tau.cwiseAbs().cwiseQuotient(limit).maxCoeff(), 1.0 / load.share - 1e-4);
}

}  // namespace
}  // namespace prowl
