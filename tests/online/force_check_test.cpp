#include "prowl/online/force_check.hpp"

#include <gtest/gtest.h>

#include "prowl/dynamics/static_equilibrium.hpp"
#include "prowl/mpc/standing_robot.hpp"
#include "tests/support/robots.hpp"

namespace prowl {
namespace {

using Eigen::VectorXd;

/// HyQ standing still, with these torques.
struct StandingPlan {
  RobotModel robot{test::hyq_description()};
  std::vector<std::vector<int>> feet = contacts_of_feet(robot);
  MpcPlan plan{robot, 1};

  StandingPlan() {
    MpcPlan::Step& step = plan.steps().front();
    step.length = 0.1;
    step.standing = 0b1111;
    step.q = standing_on_ground(robot);
    step.tau = static_equilibrium(robot, step.q, {0, 1, 2, 3}).tau;
  }
};

TEST(ForceCheck, StandingIsWithinTheCones) {
  StandingPlan standing;
  ForceCheck check(standing.robot, standing.feet, 0.6);
  EXPECT_LT(check.outside(standing.plan, 0.05), 1e-6);
}

TEST(ForceCheck, PullsAndSlidingPushesAreOutside) {
  StandingPlan standing;
  MpcPlan::Step& step = standing.plan.steps().front();
  const VectorXd still = step.tau;
  ForceCheck check(standing.robot, standing.feet, 0.6);
  step.tau = -still;  // lifts all feet
  const double pull = check.outside(standing.plan, 0.05);
  EXPECT_GT(pull, 0.1);
  step.tau = still;
  step.tau(0) += 250.0;  // one hip pushes its foot sideways
  const double push = check.outside(standing.plan, 0.05);
  EXPECT_GT(push, 0.01);
  ForceCheck rough(standing.robot, standing.feet, 5.0);
  EXPECT_LT(rough.outside(standing.plan, 0.05), push);
  step.standing = 0;
  EXPECT_EQ(check.outside(standing.plan, 0.05), 0.0) << "no foot stands";
}

}  // namespace
}  // namespace prowl
