#include "prowl/feasibility/reach_check.hpp"

#include <gmock/gmock.h>

#include "prowl/dynamics/inverse_kinematics.hpp"
#include "prowl/feasibility/joint_range_check.hpp"
#include "prowl/feasibility/prescribed_footholds.hpp"
#include "prowl/model/leg_kinematics.hpp"
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

TEST(ReachCheck, LetsPassWhatTheLegsReach) {
  EXPECT_THAT(contacts_out_of_reach(test::standing_problem()), IsEmpty());
  EXPECT_THAT(contacts_out_of_reach(test::with_base_goal(test::standing_problem(), {0.05, 0.0, -0.1})), IsEmpty());
  EXPECT_THAT(contacts_out_of_reach(test::with_base_goal(test::standing_problem(), {0.0, 0.0, 0.1})), IsEmpty());
}

// The legs are long enough, but the hips do not turn so far.
TEST(ReachCheck, KnowsTheLimitsOfTheJoints) {
  const MotionProblem problem = test::with_base_goal(test::standing_problem(), {0.1, 0.0, -0.15});
  EXPECT_THAT(
      contacts_out_of_reach(problem),
      testing::ElementsAre(AllOf(HasSubstr("goal 1, phase 'stand': contacts lf_foot, rf_foot are out of reach within "),
                                 HasSubstr("by 0.011 m or more"))));
  MotionProblem aside = problem;
  aside.boundary_constraints[1].configuration_upper(0) = 0.1;  // nothing is certain of a base that is not fixed
  EXPECT_THAT(contacts_out_of_reach(aside), IsEmpty());
}

TEST(ReachCheck, BoundsTheDistanceThatLimitsLeave) {
  std::mt19937 rng(13);
  constexpr double kMargin = 5e-3;
  int out_of_reach = 0;
  for (const RobotModel& robot : {test::hyq(), test::anymal_c(), test::solo12(), test::go2()}) {
    LegKinematics leg(robot);
    const double size = robot.nominal_configuration()(2);
    for (int i = 0; i < 40; ++i) {
      const int contact = i % 4;
      leg.update(robot.nominal_configuration().tail(robot.nu()));
      const Eigen::Vector3d target = leg.position(contact) + test::random_vector(rng, 3, 0.8 * size);
      const double least = least_distance_within_limits(robot, contact, target, kMargin);
      out_of_reach += least > 0.0;
      for (int n = 0; n < 500; ++n) {  // postures within the limits
        const Eigen::VectorXd share = 0.5 * (test::random_vector(rng, robot.nu(), 1.0).array() + 1.0);
        const Eigen::VectorXd range = robot.position_upper() - robot.position_lower();
        leg.update(robot.position_lower() + share.cwiseProduct(range));
        ASSERT_GE((leg.position(contact) - target).norm(), least - 1e-9) << robot.name();
        if (n > 0) continue;
        ASSERT_EQ(least_distance_within_limits(robot, contact, leg.position(contact), kMargin), 0.0)
            << "a place that a posture reaches";
      }
    }
  }
  EXPECT_GT(out_of_reach, 40);
  EXPECT_LT(out_of_reach, 140);
}

TEST(ReachCheck, NamesGoalPhaseContactAndLeg) {
  const auto reasons = contacts_out_of_reach(test::with_base_goal(test::standing_problem(), {0.0, 0.0, 0.5}));
  ASSERT_THAT(reasons, SizeIs(1)) << "the same of four feet is one fact";
  EXPECT_THAT(reasons[0],
              AllOf(HasSubstr("goal 1, phase 'stand'"), HasSubstr("all 4 contacts"), HasSubstr("of length 0.7")));
  EXPECT_THAT(reasons[0], testing::ContainsRegex("by 0.3[0-9]* m or more: .._foot is 1.* from .._haa_joint"));
}

TEST(ReachCheck, NamesTheContactsThatAreOutOfReachAndTheFarthest) {
  MotionProblem problem = test::with_base_goal(stepping(), {0.0, 0.0, 0.0});
  problem.phases[2].contacts[0].foothold = Eigen::Vector3d(1.5, 0.3, 0.0);
  problem.phases[2].contacts[1].foothold = Eigen::Vector3d(2.5, -0.3, 0.0);
  problem.phases[1].contacts.erase(problem.phases[1].contacts.begin());
  std::vector<std::string> reasons = contacts_out_of_reach(problem);
  std::erase_if(reasons, [](const std::string& reason) { return reason.find("apart") != std::string::npos; });
  ASSERT_THAT(reasons, SizeIs(1));
  EXPECT_THAT(reasons[0], AllOf(HasSubstr("2 contacts (lf_foot, lh_foot)"), HasSubstr("lh_foot is 2.")));
}

TEST(ReachCheck, ConcludesNothingFromWhatAGoalLeavesFree) {
  MotionProblem problem = test::with_base_goal(test::standing_problem(), {0.0, 0.0, 0.5});
  problem.boundary_constraints[1].configuration_lower(2) = -0.6;  // anything from below the start up to there
  EXPECT_THAT(contacts_out_of_reach(problem), IsEmpty());
  problem = test::with_base_goal(test::standing_problem(), {0.6, 0.0, 0.0});
  EXPECT_THAT(contacts_out_of_reach(problem), SizeIs(1));
  problem.boundary_constraints[1].configuration_lower(0) = -std::numeric_limits<double>::infinity();
  EXPECT_THAT(contacts_out_of_reach(problem), IsEmpty());
}

/// A standing robot whose base is to be so much higher at the end, however it is turned.
MotionProblem raised(double height) {
  MotionProblem problem = test::with_base_goal(test::standing_problem(), {0.0, 0.0, height});
  problem.boundary_constraints[1].configuration_lower.segment<3>(3).setConstant(-4.0);
  problem.boundary_constraints[1].configuration_upper.segment<3>(3).setConstant(4.0);
  return problem;
}

TEST(ReachCheck, TakesAnyRotationWhereTheGoalLeavesItFree) {
  EXPECT_THAT(contacts_out_of_reach(test::with_base_goal(test::standing_problem(), {0.0, 0.0, 0.4})), SizeIs(1));
  MotionProblem problem = raised(0.4);
  std::erase_if(problem.phases[0].contacts, [](const PhaseContact& held) { return held.contact % 2 == 1; });
  EXPECT_THAT(contacts_out_of_reach(problem), IsEmpty()) << "on its fore feet it may hang its head";
}

// A base of free orientation brings one leg nearer only by taking another away.
TEST(ReachCheck, ProvesAHeightOutOfReachHoweverTheBaseIsTurned) {
  EXPECT_THAT(contacts_out_of_reach(raised(0.1)), IsEmpty());
  const auto reasons = contacts_out_of_reach(raised(0.5));
  ASSERT_THAT(reasons, SizeIs(1));
  EXPECT_THAT(reasons[0], AllOf(HasSubstr("goal 1, phase 'stand'"), HasSubstr("lf_foot, lh_foot, rf_foot, rh_foot"),
                                HasSubstr("for any base orientation"), HasSubstr("1.08 m")));
  MotionProblem aside = raised(0.5);
  const double infinity = std::numeric_limits<double>::infinity();
  aside.boundary_constraints[1].configuration_lower.head<2>().setConstant(-infinity);
  aside.boundary_constraints[1].configuration_upper.head<2>().setConstant(infinity);
  EXPECT_THAT(contacts_out_of_reach(aside), SizeIs(1)) << "wherever it stands";
}

TEST(ReachCheck, ProvesAHeightOutOfReachForFootholdsThatTheOptimiserChooses) {
  MotionProblem problem = raised(0.5);
  Phase flight = problem.phases[0];
  flight.name = "flight";
  flight.contacts.clear();
  problem.phases.push_back(flight);
  problem.phases.push_back(problem.phases[0]);
  problem.phases[2].name = "landed";
  problem.boundary_constraints[1].at = PhaseFraction::end_of(2);
  EXPECT_THAT(contacts_out_of_reach(problem),
              testing::ElementsAre(AllOf(HasSubstr("phase 'landed'"), HasSubstr("for any base orientation"))));
  problem.boundary_constraints[1].at = PhaseFraction{1, 0.5};
  EXPECT_THAT(contacts_out_of_reach(problem), IsEmpty()) << "in the air it may be anywhere";
  problem.boundary_constraints[1].at = PhaseFraction::end_of(2);
  problem.surfaces.push_back({.name = "platform", .point = {0.0, 0.0, 0.5}});
  for (PhaseContact& held : problem.phases[2].contacts) held.surface = 1;
  EXPECT_THAT(contacts_out_of_reach(problem), IsEmpty());
}

TEST(ReachCheck, TakesTheFootholdsOfLandings) {
  MotionProblem problem = stepping();
  problem.phases[2].contacts[0].foothold = Eigen::Vector3d(0.5, 0.3, 0.0);
  EXPECT_THAT(contacts_out_of_reach(problem), IsEmpty());
  problem.phases[2].contacts[0].foothold = Eigen::Vector3d(1.5, 0.3, 0.0);
  EXPECT_THAT(contacts_out_of_reach(problem), IsEmpty()) << "the base may come along";
  const auto reasons = contacts_out_of_reach(test::with_base_goal(problem, {0.1, 0.0, 0.0}));
  ASSERT_THAT(reasons, SizeIs(1));
  EXPECT_THAT(reasons[0], AllOf(HasSubstr("goal 1, phase 'landed'"), HasSubstr("lf_foot")));

  problem.phases[2].contacts[0].foothold = Eigen::Vector3d(3.5, 0.3, 0.0);
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
  problem.boundary_constraints[1].configuration_upper(0) = 1.0;  // the base may come along
  EXPECT_THAT(contacts_out_of_reach(problem), IsEmpty());
}

/// Where a posture is found there is one: that is what must never be called out of reach.
TEST(ReachCheck, NeverForbidsAPostureThatExists) {
  std::mt19937 rng(12);
  int found = 0, forbidden = 0, forbidden_however_turned = 0;
  for (const RobotModel& robot : {test::hyq(), test::anymal_c(), test::solo12(), test::go2()}) {
    const MotionProblem standing = test::standing_problem(robot);
    const double height = robot.nominal_configuration()(2);
    std::vector<ContactTarget> targets;
    const auto footholds = prescribed_footholds(standing, ContactSchedule(standing));
    for (int c = 0; c < 4; ++c) targets.push_back({c, *footholds[c]});
    for (int i = 0; i < 100; ++i) {
      MotionProblem problem = test::with_base_goal(standing, test::random_vector(rng, 3, 0.5 * height));
      Eigen::VectorXd& q = problem.boundary_constraints[1].q_ref;
      set_base_rotation(q, base_rotation(q) * so3::exp(test::random_vector(rng, 3, 0.3)));
      const bool is_forbidden = !contacts_out_of_reach(problem).empty();
      forbidden += is_forbidden;
      problem.boundary_constraints[1].configuration_lower.segment<3>(3).setConstant(-4.0);
      problem.boundary_constraints[1].configuration_upper.segment<3>(3).setConstant(4.0);
      const bool is_forbidden_however_turned = !contacts_out_of_reach(problem).empty();
      forbidden_however_turned += is_forbidden_however_turned;
      if (!inverse_kinematics(robot, q, targets).converged) continue;
      ++found;
      EXPECT_FALSE(is_forbidden) << robot.name();
      EXPECT_FALSE(is_forbidden_however_turned) << robot.name();
    }
  }
  EXPECT_GT(found, 50);
  EXPECT_GT(forbidden, 20);
  EXPECT_GT(forbidden_however_turned, 10);
}

}  // namespace
}  // namespace prowl
