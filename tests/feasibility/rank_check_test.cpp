#include "prowl/feasibility/rank_check.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numeric>
#include <random>

#include "prowl/dynamics/body_bounds.hpp"
#include "prowl/dynamics/rigid_body_terms.hpp"
#include "prowl/guess/initial_guess.hpp"
#include "tests/support/everything_problem.hpp"
#include "tests/support/robots.hpp"

namespace prowl {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::vector<int> all_contacts(const RobotModel& robot) {
  std::vector<int> contacts(robot.contacts().size());
  std::iota(contacts.begin(), contacts.end(), 0);
  return contacts;
}

/// Place of a foot from the first joint of its leg, in the base [m].
Eigen::Vector3d leg_vector(const RobotModel& robot, const Eigen::VectorXd& q, int foot) {
  RigidBodyTerms terms(robot);
  terms.update_kinematics(q);
  return base_rotation(q).transpose() * (terms.contact_position(foot) - base_position(q)) -
         contact_reach(robot, foot).root;
}

/// Legs stretched, each foot under the axis of its first joint, about which the leg turns sideways.
Eigen::VectorXd stretched(const RobotModel& robot) {
  Eigen::VectorXd q = robot.nominal_configuration();
  q.tail(robot.nu()).setZero();
  for (int foot = 0; foot < 4; ++foot) {
    const Eigen::Vector3d leg = leg_vector(robot, q, foot);
    double& sideways = q(7 + 3 * foot);
    sideways = std::atan(leg.y() / leg.z());
    if (std::abs(leg_vector(robot, q, foot).y()) > 1e-9) sideways = -sideways;
    EXPECT_NEAR(leg_vector(robot, q, foot).y(), 0.0, 1e-9) << robot.name();
  }
  return q;
}

TEST(LostRank, IsNoneInPosturesToWorkIn) {
  std::mt19937 rng(3);
  std::normal_distribution<double> some(0.0, 0.3);
  for (const RobotModel& robot : {test::hyq(), test::anymal_c(), test::solo12(), test::talos()}) {
    for (int i = 0; i < 20; ++i) {
      Eigen::VectorXd q = robot.nominal_configuration();
      if (i > 0) q.tail(robot.nu()) += Eigen::VectorXd::NullaryExpr(robot.nu(), [&] { return some(rng); });
      EXPECT_FALSE(lost_rank(robot, q, all_contacts(robot))) << robot.name() << ", posture " << i;
    }
  }
  EXPECT_FALSE(lost_rank(test::hyq(), test::hyq().nominal_configuration(), {}));
}

/// Four parallel legs push and pull crosswise, whose forces and moments cancel; three cannot.
TEST(LostRank, IsOneDirectionOfFourStretchedLegs) {
  for (const RobotModel& robot : {test::hyq(), test::solo12()}) {
    const auto lost = lost_rank(robot, stretched(robot), {0, 1, 2, 3});
    ASSERT_TRUE(lost) << robot.name();
    EXPECT_EQ(lost->rank, 11) << robot.name();
    EXPECT_EQ(lost->beside, 12) << robot.name();
    EXPECT_THAT(lost->contacts, ElementsAre(0, 1, 2, 3)) << robot.name();
    EXPECT_FALSE(lost_rank(robot, stretched(robot), {0, 1, 3})) << robot.name();
  }
}

TEST(LostRank, IsToldOfThePhaseThatStartsThere) {
  const auto [problem, mesh] = test::everything(
      test::solo12(), {test::phase_on("three", {0, 1, 2}, 0.3, 2), test::phase_on("four", {0, 1, 2, 3}, 0.3, 2)});
  Trajectory guess = initial_guess({problem, mesh});
  EXPECT_THAT(postures_that_lose_rank(problem, guess), IsEmpty());
  for (TrajectoryPoint& point : guess.nodes) point.q = stretched(problem.robot);
  EXPECT_THAT(postures_that_lose_rank(problem, guess),
              ElementsAre(AllOf(HasSubstr("start of phase 'four'"), HasSubstr("rank 11 instead of 12"))));
}

}  // namespace
}  // namespace prowl
