#include "prowl/feasibility/slide_check.hpp"

#include <gmock/gmock.h>

#include "tests/support/standing_problem.hpp"

namespace prowl {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::optional<std::string> why_it_slides(const MotionProblem& problem) {
  return why_it_slides(problem, ContactSchedule(problem));
}

TEST(SlideCheck, LetsPassWhereFrictionSuffices) {
  EXPECT_FALSE(why_it_slides(test::standing_problem(test::hyq(), 0.0, 0.01)));
  EXPECT_FALSE(why_it_slides(test::standing_problem(test::hyq(), 15.0, 0.27)));
  EXPECT_FALSE(why_it_slides(test::standing_problem(test::hyq(), 30.0, 0.58)));
}

TEST(SlideCheck, NamesPhaseSurfaceAndTheFrictionThatIsNeeded) {
  for (const RobotModel& robot : {test::hyq(), test::anymal_c(), test::go2(), test::solo12()}) {
    const auto steep =
        why_it_slides(test::with_base_goal(test::standing_problem(robot, 30.0, 0.5), Eigen::Vector3d::Zero()));
    ASSERT_TRUE(steep) << robot.name();
    EXPECT_THAT(*steep, AllOf(HasSubstr("phase 'stand'"), HasSubstr("surface 'slope' has 0.5 and needs 0.577")));
    const auto smooth = why_it_slides(test::standing_problem(robot, 15.0, 0.2));
    ASSERT_TRUE(smooth) << robot.name() << ": its feet alone say where it has to stay";
    EXPECT_THAT(*smooth, AllOf(HasSubstr("has 0.2 and needs 0.268"), HasSubstr("contact")));
  }
}

// In a tenth of a second nothing slides far, and a robot that is let go may go.
TEST(SlideCheck, LetsPassWhatIsShortOrFree) {
  MotionProblem problem = test::with_base_goal(test::standing_problem(test::hyq(), 30.0, 0.5), Eigen::Vector3d::Zero());
  problem.phases[0].duration = {0.1, 0.1};
  EXPECT_FALSE(why_it_slides(problem));
  problem.phases[0].duration = {0.1, 2.0};
  EXPECT_FALSE(why_it_slides(problem)) << "the optimiser may choose the short time";
  problem = test::standing_problem(test::hyq(), 30.0, 0.5);
  problem.phases[0].contacts.clear();
  problem.phases[0].duration = {0.3, 0.3};
  EXPECT_FALSE(why_it_slides(problem)) << "a fall";
}

TEST(SlideCheck, KnowsThatARobotInTheAirFalls) {
  MotionProblem problem = test::with_base_goal(test::standing_problem(), Eigen::Vector3d::Zero());
  problem.phases[0].contacts.clear();
  problem.phases[0].duration = {0.5, 0.5};
  const auto reason = why_it_slides(problem);
  ASSERT_TRUE(reason);
  EXPECT_THAT(*reason, HasSubstr("no contact holds the robot"));
  // Thrown up fast enough to be back at that time, it is where the goal wants it.
  problem.boundary_constraints[0].velocity_lower(2) = problem.boundary_constraints[0].velocity_upper(2) =
      0.5 * 0.5 * 9.81;
  EXPECT_FALSE(why_it_slides(problem));
}

// A level step after the slope: while it is not touched it is of no use, and too late it is none either.
TEST(SlideCheck, CountsTheSurfacesTouchedSoFar) {
  MotionProblem problem = test::standing_problem(test::hyq(), 30.0, 0.5);
  problem.surfaces.push_back({.name = "step", .friction = 0.5});
  Phase landed = problem.phases[0];
  landed.contacts[0].surface = 1;
  Phase lifted = problem.phases[0];
  lifted.contacts.erase(lifted.contacts.begin());
  for (const double seconds : {0.1, 2.0}) {
    problem.phases.resize(1);
    problem.phases[0].duration = {seconds, seconds};
    lifted.duration = landed.duration = {0.1, 0.1};
    problem.phases.push_back(lifted);
    problem.phases.push_back(landed);
    EXPECT_EQ(why_it_slides(problem).has_value(), seconds > 1.0);
  }
}

}  // namespace
}  // namespace prowl
