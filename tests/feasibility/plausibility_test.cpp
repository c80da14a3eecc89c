#include "prowl/feasibility/plausibility.hpp"

#include <gmock/gmock.h>

#include "tests/support/meshed_problem.hpp"
#include "tests/support/standing_problem.hpp"

namespace prowl {
namespace {

using test::on_even_mesh;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::vector<std::string> lines_of(const DiscreteProblem& of) { return implausibilities(of.problem, of.mesh); }

TEST(Plausibility, SaysNothingOfWhatIsUsual) {
  EXPECT_THAT(lines_of(on_even_mesh(test::standing_problem(test::hyq(), 0.0, 1.2), 8)), IsEmpty());
}

TEST(Plausibility, NamesTheSurfaceThatNoSoleSticksTo) {
  EXPECT_THAT(lines_of(on_even_mesh(test::standing_problem(test::hyq(), 0.0, 50.0), 8)),
              ElementsAre(AllOf(HasSubstr("'slope'"), HasSubstr("friction 50;"))));
}

TEST(Plausibility, NamesThePhaseWithMillisecondsForSeconds) {
  MotionProblem problem = test::standing_problem();
  problem.phases[0].duration = {2000.0, 2000.0};
  EXPECT_THAT(lines_of(on_even_mesh(problem, 8)),
              ElementsAre(AllOf(HasSubstr("'stand'"), HasSubstr("intervals of 250 s"))));
}

TEST(Plausibility, LooksAtTheShortestDurationAndTheLongestInterval) {
  MotionProblem problem = test::standing_problem();
  problem.phases[0].duration = {2.0, 2000.0};
  EXPECT_THAT(lines_of(on_even_mesh(problem, 8)), IsEmpty());
  const PhaseMesh uneven({0.65, 0.05, 0.05, 0.05, 0.05, 0.05, 0.05, 0.05});
  EXPECT_THAT(lines_of({problem, {{uneven}}}), ElementsAre(HasSubstr("intervals of 1.3 s")));
}

/// Two diagonal feet may carry a motion, but not its end.
TEST(Plausibility, NamesAnEndThatNothingHolds) {
  MotionProblem problem = test::with_base_goal(test::standing_problem(), {0.0, 0.0, -0.05});
  BoundaryConstraint& goal = problem.boundary_constraints.back();
  goal.velocity_lower.head<6>().setZero();
  goal.velocity_upper.head<6>().setZero();
  EXPECT_THAT(lines_of(on_even_mesh(problem, 8)), IsEmpty());
  auto& held = problem.phases[0].contacts;
  held = {held[0], held[3]};
  EXPECT_THAT(lines_of(on_even_mesh(problem, 8)),
              ElementsAre(HasSubstr("ends at rest on two points: no torque holds")));
  problem.boundary_constraints.back().velocity_upper.setConstant(1.0);
  EXPECT_THAT(lines_of(on_even_mesh(problem, 8)), IsEmpty()) << "it does not end at rest";
}

}  // namespace
}  // namespace prowl
