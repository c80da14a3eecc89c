#include "prowl/feasibility/reach_check.hpp"

#include <gmock/gmock.h>

#include "prowl/dynamics/inverse_kinematics.hpp"
#include "prowl/feasibility/prescribed_places.hpp"
#include "prowl/model/so3.hpp"
#include "tests/support/random_point.hpp"
#include "tests/support/standing_problem.hpp"

namespace prowl {
namespace {

using testing::AllOf;
using testing::Each;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

std::vector<std::string> contacts_out_of_reach(const MotionProblem& problem) {
  return contacts_out_of_reach(problem, ContactSchedule(problem));
}

TEST(ReachCheck, LetsPassWhatTheLegsReach) {
  EXPECT_THAT(contacts_out_of_reach(test::standing_problem()), IsEmpty());
  EXPECT_THAT(contacts_out_of_reach(test::with_base_goal(test::standing_problem(), {0.1, 0.0, -0.15})), IsEmpty());
  // Straight legs: HyQ stands at 0.61 m, its legs are 0.78 m.
  EXPECT_THAT(contacts_out_of_reach(test::with_base_goal(test::standing_problem(), {0.0, 0.0, 0.1})), IsEmpty());
}

TEST(ReachCheck, NamesGoalPhaseContactAndLeg) {
  const auto reasons = contacts_out_of_reach(test::with_base_goal(test::standing_problem(), {0.0, 0.0, 0.5}));
  ASSERT_THAT(reasons, SizeIs(4));
  EXPECT_THAT(reasons, Each(AllOf(HasSubstr("goal 1, phase 'stand'"), HasSubstr("is 0.7"))));
  EXPECT_THAT(reasons[0], AllOf(HasSubstr("lf_foot"), HasSubstr("lf_haa_joint")));
}

TEST(ReachCheck, ConcludesNothingFromWhatAGoalLeavesFree) {
  MotionProblem problem = test::with_base_goal(test::standing_problem(), {0.0, 0.0, 0.5});
  problem.boundary_conditions[1].configuration_lower(2) = -0.6;  // anything from below the start up to there
  EXPECT_THAT(contacts_out_of_reach(problem), IsEmpty());
  problem = test::with_base_goal(test::standing_problem(), {0.6, 0.0, 0.0});
  EXPECT_THAT(contacts_out_of_reach(problem), SizeIs(4));
  problem.boundary_conditions[1].configuration_lower(0) = -std::numeric_limits<double>::infinity();
  EXPECT_THAT(contacts_out_of_reach(problem), IsEmpty());
}

TEST(ReachCheck, TakesAnyRotationWhereTheGoalLeavesItFree) {
  MotionProblem problem = test::with_base_goal(test::standing_problem(), {0.0, 0.0, 0.4});
  EXPECT_THAT(contacts_out_of_reach(problem), SizeIs(4));
  problem.boundary_conditions[1].configuration_lower.segment<3>(3).setConstant(-1.0);
  EXPECT_THAT(contacts_out_of_reach(problem), IsEmpty()) << "it may hang its head";
}

MotionProblem stepping() {
  MotionProblem problem = test::standing_problem();
  Phase lifted = problem.phases[0], landed = problem.phases[0];
  lifted.name = "lifted";
  lifted.contacts.erase(lifted.contacts.begin());
  landed.name = "landed";
  problem.phases.push_back(lifted);
  problem.phases.push_back(landed);
  return problem;
}

TEST(ReachCheck, TakesThePlacesOfLandings) {
  MotionProblem problem = stepping();
  problem.phases[2].contacts[0].place = Eigen::Vector3d(0.5, 0.3, 0.0);
  EXPECT_THAT(contacts_out_of_reach(problem), IsEmpty());
  problem.phases[2].contacts[0].place = Eigen::Vector3d(1.5, 0.3, 0.0);
  EXPECT_THAT(contacts_out_of_reach(problem), IsEmpty()) << "the base may come along";
  const auto reasons = contacts_out_of_reach(test::with_base_goal(problem, {0.1, 0.0, 0.0}));
  ASSERT_THAT(reasons, SizeIs(1));
  EXPECT_THAT(reasons[0], AllOf(HasSubstr("goal 1, phase 'landed'"), HasSubstr("lf_foot")));

  problem.phases[2].contacts[0].place = Eigen::Vector3d(3.5, 0.3, 0.0);
  const auto apart = contacts_out_of_reach(problem);
  ASSERT_THAT(apart, testing::Not(IsEmpty())) << "not even by splits";
  EXPECT_THAT(apart, Each(AllOf(HasSubstr("phase 'landed'"), HasSubstr("lf_foot"), HasSubstr("apart"))));
}

TEST(ReachCheck, TakesTheNearestOfAPatchWhereTheOptimiserChooses) {
  MotionProblem problem = test::with_base_goal(stepping(), {0.0, 0.0, 0.0});
  problem.surfaces.push_back({.name = "stone", .patch = {{-0.2, -0.2}, {0.2, -0.2}, {0.2, 0.2}, {-0.2, 0.2}}});
  problem.phases[2].contacts[0].surface = 1;
  problem.surfaces[1].point = {0.6, 0.4, 0.1};
  EXPECT_THAT(contacts_out_of_reach(problem), IsEmpty());
  problem.surfaces[1].point = {1.5, 0.4, 0.1};
  EXPECT_THAT(contacts_out_of_reach(problem), SizeIs(1));
  problem.boundary_conditions[1].configuration_upper(0) = 1.0;  // the base may come along
  EXPECT_THAT(contacts_out_of_reach(problem), IsEmpty());
}

/// Where a posture is found there is one: that is what must never be called out of reach.
TEST(ReachCheck, NeverForbidsAPostureThatExists) {
  std::mt19937 rng(12);
  int found = 0, forbidden = 0;
  for (const RobotModel& robot : {test::hyq(), test::anymal_c(), test::solo12(), test::go2()}) {
    const MotionProblem standing = test::standing_problem(robot);
    const double height = robot.nominal_configuration()(2);
    std::vector<ContactTarget> targets;
    const auto places = prescribed_places(standing, ContactSchedule(standing));
    for (int c = 0; c < 4; ++c) targets.push_back({c, *places[c]});
    for (int i = 0; i < 100; ++i) {
      MotionProblem problem = test::with_base_goal(standing, test::random_vector(rng, 3, 0.5 * height));
      Eigen::VectorXd& q = problem.boundary_conditions[1].q_ref;
      set_base_rotation(q, base_rotation(q) * so3::exp(test::random_vector(rng, 3, 0.3)));
      const bool is_forbidden = !contacts_out_of_reach(problem).empty();
      forbidden += is_forbidden;
      if (!inverse_kinematics(robot, q, targets).converged) continue;
      ++found;
      EXPECT_FALSE(is_forbidden) << robot.name();
    }
  }
  EXPECT_GT(found, 50);
  EXPECT_GT(forbidden, 20);
}

}  // namespace
}  // namespace prowl
