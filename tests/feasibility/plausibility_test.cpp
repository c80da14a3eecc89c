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

}  // namespace
}  // namespace prowl
