#include "prowl/feasibility/feasibility.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>

#include "prowl/guess/initial_guess.hpp"
#include "prowl/plan.hpp"
#include "prowl/solvers/foreign/ipopt_solver.hpp"
#include "tests/support/task_test.hpp"

namespace prowl {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

/// HyQ stands for two seconds on a slope that falls towards -x, and ends at rest where it began.
std::string on_a_slope(double degrees, double friction) {
  const double angle = degrees * 3.14159265358979 / 180.0;
  return "robot = \"hyq.toml\"\n[[surface]]\nname = \"slope\"\nnormal = [" + std::to_string(-std::sin(angle)) +
         ", 0, " + std::to_string(std::cos(angle)) + "]\nfriction = " + std::to_string(friction) + R"(
[start]
on = "slope"
[[phase]]
name = "stand"
contacts = "all"
duration_s = 2.0
intervals = 4
[[goal]]
time_s = 2.0
base_displacement_m = [0, 0, 0]
base_linear_velocity_mps = [0, 0, 0]
base_angular_velocity_radps = [0, 0, 0]
[cost]
joint_velocity = 0.1
base_linear_acceleration = 1.0
joint_acceleration = 0.01
torque = 1e-4
)";
}

const std::string kStand = R"(robot = "hyq.toml"
[[phase]]
name = "stand"
contacts = "all"
duration_s = 1.0
intervals = 4
[[goal]]
time_s = 1.0
base_displacement_m = [0, 0, -0.05]
[cost]
joint_velocity = 0.1
base_linear_acceleration = 1.0
joint_acceleration = 0.01
torque = 1e-4
)";

class Feasibility : public test::TaskTest {
 protected:
  static std::vector<std::string> doubts_of(const DiscreteProblem& discrete) {
    return doubts(discrete, initial_guess(discrete), IpoptSolver());
  }
  static std::vector<std::string> proofs_of(const DiscreteProblem& discrete) {
    return proofs_of_infeasibility(discrete.problem, discrete.schedule);
  }
};

TEST_F(Feasibility, OfASlopeIsAMatterOfFriction) {
  for (const auto& [degrees, friction, needed] :
       {std::tuple{30.0, 0.5, "0.5 and needs 0.577"}, {15.0, 0.2, "0.2 and needs 0.268"}}) {
    const DiscreteProblem slope = prepared(on_a_slope(degrees, friction));
    EXPECT_THAT(proofs_of(slope), ElementsAre(AllOf(HasSubstr("phase 'stand'"),
                                                    HasSubstr(std::string("surface 'slope' has ") + needed))));
    const Plan plan = make_plan(slope, IpoptSolver(), {});
    EXPECT_EQ(plan.result.status, SolveStatus::infeasible);
    EXPECT_EQ(plan.result.iterations, 0);
    EXPECT_EQ(plan.reasons, proofs_of(slope));
    EXPECT_FALSE(plan.certificate.passed);
  }
}

TEST_F(Feasibility, OfAGentleSlopeIsNotDoubted) {
  const DiscreteProblem slope = prepared(on_a_slope(15.0, 0.5));
  EXPECT_THAT(proofs_of(slope), IsEmpty());
  EXPECT_THAT(doubts_of(slope), IsEmpty());
  const Plan plan = make_plan(slope, IpoptSolver(), {});
  EXPECT_EQ(plan.result.status, SolveStatus::converged);
  EXPECT_THAT(plan.hints, IsEmpty());
}

TEST_F(Feasibility, OfAGoalOutOfReachNamesTheFeet) {
  const DiscreteProblem high =
      prepared(test::replaced(kStand, "[0, 0, -0.05]", "[0, 0, 0.5]\nbase_rpy_rad = [0, 0, 0]"));
  EXPECT_THAT(proofs_of(high), ElementsAre(AllOf(HasSubstr("goal 1, phase 'stand'"),
                                                 HasSubstr("all 4 contacts are out of reach"), HasSubstr("_foot is"))));
}

TEST_F(Feasibility, OfAGoalOutOfReachNeedsNoOrientation) {
  const DiscreteProblem high = prepared(test::replaced(kStand, "[0, 0, -0.05]", "[0, 0, 0.5]"));
  EXPECT_THAT(proofs_of(high), ElementsAre(AllOf(HasSubstr("goal 1, phase 'stand'"), HasSubstr("lf_foot"),
                                                 HasSubstr("for any base orientation"))));
}

TEST_F(Feasibility, OfAFootholdOutOfReachNamesTheFoot) {
  const std::string step = R"(
[[phase]]
name = "swing"
contacts = ["rf_foot", "lh_foot", "rh_foot"]
duration_s = 0.5
intervals = 4
[[phase]]
name = "land"
contacts = ["rf_foot", "lh_foot", "rh_foot", { contact = "lf_foot", place_m = [PLACE, 0.3, 0] }]
duration_s = 0.5
intervals = 4
[[goal]]
phase = "land"
base_displacement_m = [0.1, 0, 0]
base_rpy_rad = [0, 0, 0]
)";
  EXPECT_THAT(proofs_of(prepared(kStand + test::replaced(step, "PLACE", "0.5"))), IsEmpty());
  EXPECT_THAT(proofs_of(prepared(kStand + test::replaced(step, "PLACE", "1.5"))),
              ElementsAre(AllOf(HasSubstr("goal 2, phase 'land'"), HasSubstr("lf_foot"))));
}

/// Too weak a joint may still do, in a posture or a motion that nobody has thought of: a hint, and only after a solve.
TEST_F(Feasibility, OfWeakJointsIsDoubted) {
  const DiscreteProblem stand = prepared(kStand, test::kWeakHyqFile);
  EXPECT_THAT(proofs_of(stand), IsEmpty());
  const Plan plan = make_plan(stand, IpoptSolver(), {.solver = {.max_iterations = 3}});
  EXPECT_NE(plan.result.status, SolveStatus::converged);
  ASSERT_THAT(plan.hints, SizeIs(2)) << "both ends of the phase";
  EXPECT_THAT(plan.hints[0],
              AllOf(HasSubstr("start of phase 'stand'"), HasSubstr("_kfe_joint needs"), HasSubstr("N m (limit 10)")));
  EXPECT_THAT(plan.hints[1], HasSubstr("goal 1, end of phase 'stand'"));
}

/// A solver that stops short of an optimum nobody needs leaves nothing to doubt in a motion that passes.
TEST_F(Feasibility, OfAMotionThatPassesIsNotDoubted) {
  const DiscreteProblem stand = prepared(test::replaced(kStand, "intervals = 4", "intervals = 40"));
  const Plan plan = make_plan(stand, IpoptSolver(), {.solver = {.tolerance = 1e-16, .max_iterations = 50}});
  EXPECT_NE(plan.result.status, SolveStatus::converged);
  EXPECT_TRUE(plan.certificate.passed);
  EXPECT_THAT(plan.hints, IsEmpty());
}

TEST_F(Feasibility, OfAGoalInTheMiddleOfAPhaseIsDoubtedToo) {
  const std::string wide = test::replaced(kStand, "time_s = 1.0", "time_s = 0.5");
  const auto hints =
      doubts_of(prepared(test::replaced(wide, "[0, 0, -0.05]", "[0.35, 0, -0.05]\nbase_rpy_rad = [0, 0, 0]")));
  EXPECT_THAT(hints, testing::Contains(AllOf(HasSubstr("goal 1, phase 'stand'"), HasSubstr("no posture found"))));
  const auto is_of_the_goal = [](const std::string& hint) { return hint.find("goal 1") != std::string::npos; };
  EXPECT_EQ(std::ranges::count_if(hints, is_of_the_goal), 1) << "the same of several feet is one line";
}

TEST_F(Feasibility, OfAPostureThatIsNotFoundIsDoubted) {
  // Within the length of the legs, but not within what their joints do: a proof only if the base may not turn.
  const DiscreteProblem low = prepared(test::replaced(kStand, "[0, 0, -0.05]", "[0.55, 0, -0.05]"));
  EXPECT_THAT(proofs_of(low), IsEmpty());
  EXPECT_THAT(doubts_of(low), testing::Contains(AllOf(HasSubstr("end of phase 'stand'"), HasSubstr("no posture found"),
                                                      HasSubstr("h_foot"))));
}

TEST_F(Feasibility, OfTheShippedTasksIsNeverDisproven) {
  int tasks = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(std::string(PROWL_SOURCE_DIR) + "/tasks")) {
    if (entry.path().extension() != ".toml") continue;
    ++tasks;
    const MotionProblem problem = read_task_file(entry.path(), test::test_search(), {}).problem;
    EXPECT_THAT(proofs_of_infeasibility(problem, ContactSchedule(problem)), IsEmpty()) << entry.path();
  }
  EXPECT_GE(tasks, 10);
}

}  // namespace
}  // namespace prowl
