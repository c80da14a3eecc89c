#include "prowl/diagnosis/diagnosis.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "prowl/diagnosis/change_search.hpp"
#include "prowl/mesh/mesh_levels.hpp"
#include "prowl/solvers/foreign/ipopt_solver.hpp"
#include "prowl/solvers/riccati/riccati_solver.hpp"
#include "screen/diagnosis_text.hpp"
#include "tests/support/failing_solver.hpp"
#include "tests/support/task_test.hpp"

namespace prowl {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const std::string kCrouch = R"(robot = "hyq.toml"
[[phase]]
name = "crouch"
contacts = "all"
duration_s = 1.0
intervals = 8
[[goal]]
time_s = 1.0
base_displacement_m = [0, 0, -0.1]
base_rpy_rad = [0, 0, 0]
base_linear_velocity_mps = [0, 0, 0]
base_angular_velocity_radps = [0, 0, 0]
[cost]
joint_velocity = 0.1
base_linear_acceleration = 1.0
base_angular_acceleration = 1.0
joint_acceleration = 0.01
torque = 1e-4
)";

class DiagnosisTest : public test::TaskTest {
 protected:
  static Diagnosis diagnosis(const DiscreteProblem& discrete) {
    return diagnose(discrete, RiccatiSolver(), IpoptSolver(), {});
  }
};

TEST_F(DiagnosisTest, OfATaskWithAPlanIsThatItHasOne) {
  std::vector<std::string> steps;
  const auto keep = [&](const std::string& what) { steps.push_back(what); };
  const Diagnosis found = diagnose(prepared(kCrouch), RiccatiSolver(), IpoptSolver(), {.on_step = keep});
  EXPECT_THAT(steps, testing::ElementsAre("solving the task on 8 intervals", "planning the task"))
      << "a small mesh is solved once";
  EXPECT_TRUE(found.solvable);
  EXPECT_TRUE(found.kind.empty());
  EXPECT_TRUE(found.changes.empty());
}

// What is tried is told in words, with how much of it is done.
TEST_F(DiagnosisTest, CountsWhatItTries) {
  std::vector<std::string> steps;
  const auto keep = [&](const std::string& what) { steps.push_back(what); };
  diagnose(prepared(kCrouch, test::kWeakHyqFile), RiccatiSolver(), IpoptSolver(), {.on_step = keep});
  std::erase_if(steps, [](const std::string& what) { return !what.starts_with("trying ") || !what.ends_with(")"); });
  ASSERT_GT(steps.size(), 3u);
  EXPECT_THAT(steps[0], testing::MatchesRegex("trying .* \\(1 of about [0-9]+\\)"));
  EXPECT_THAT(steps[1], testing::MatchesRegex("trying .* \\(2 of about [0-9]+\\)"));
  EXPECT_THAT(steps, testing::Contains(testing::StartsWith("trying torque limits of all joints x 1.5 (")));
}

/// A mesh too coarse is no matter of the task, and needs no search.
TEST_F(DiagnosisTest, OfAPlanThatFailsItsCertificateNamesTheChecks) {
  const DiscreteProblem coarse = prepared(kCrouch);
  const Diagnosis found = diagnosis(coarse);
  EXPECT_TRUE(found.solvable);
  EXPECT_FALSE(found.certificate.passed);
  EXPECT_THAT(diagnosis_headline(found, coarse.problem),
              AllOf(HasSubstr("fails its certificate: local integration error ("), HasSubstr(" > 0.0001"),
                    testing::EndsWith("; its mesh is too coarse: prowl plan --refine")));
}

TEST_F(DiagnosisTest, NamesTheJointThatMayNotBend) {
  const DiscreteProblem stiff =
      prepared(kCrouch, test::kHyqFile + "[limits.lh_kfe_joint]\nposition_rad = [1.4, 1.55]\n");
  const Diagnosis found = diagnosis(stiff);
  EXPECT_FALSE(found.solvable);
  EXPECT_EQ(found.kind, "joint_position");
  EXPECT_EQ(found.subject, "lh_kfe_joint");
  ASSERT_FALSE(found.breaches.empty());
  const Breach& breach = found.breaches.front();
  EXPECT_EQ(breach.subject, "lh_kfe_joint");
  EXPECT_EQ(breach.time, 1.0);
  ASSERT_FALSE(found.changes.empty());
  const ProposedChange& change = found.changes.front();
  EXPECT_NEAR(change.from, 0.15, 1e-12);
  EXPECT_TRUE(change.is_proved);
  EXPECT_NEAR(change.to, std::stod(fmt::format("{:.3g}", change.to)), 1e-9) << "what is printed is not what was proved";
  EXPECT_NEAR(0.5 * (change.to - change.from), breach.amount, 0.05)
      << "two ways to the same: a range wider on both sides";
  EXPECT_THAT(diagnosis_headline(found, stiff.problem),
              AllOf(HasSubstr("phase 1 'crouch', lh_kfe_joint, joint position at 1 s: "),
                    HasSubstr("rad beyond its bound; solvable on a finer mesh (--refine) with position "
                              "range of lh_kfe_joint ["),
                    HasSubstr("] rad instead of [1.4, 1.55] rad")));
}

TEST_F(DiagnosisTest, NamesWeakJoints) {
  const DiscreteProblem weak = prepared(kCrouch, test::kWeakHyqFile);
  const Diagnosis found = diagnosis(weak);
  EXPECT_EQ(found.kind, "torque") << diagnosis_text(found, weak.problem);
  EXPECT_THAT(found.subject,
              AllOf(HasSubstr("f_kfe_joint"), testing::Not(HasSubstr("haa")), testing::Not(HasSubstr("lh_kfe"))));
}

TEST_F(DiagnosisTest, OfASlopeNamesFrictionAndHowMuchIsNeeded) {
  const DiscreteProblem slope = prepared(
      "robot = \"hyq.toml\"\n[[surface]]\nname = \"slope\"\nnormal = [-0.5, 0, 0.8660254]\nfriction = 0.4\n"
      "[start]\non = \"slope\"\n" +
      test::replaced(test::replaced(kCrouch, "robot = \"hyq.toml\"\n", ""), "base_rpy_rad = [0, 0, 0]\n", ""));
  const Diagnosis found = diagnosis(slope);
  EXPECT_EQ(found.kind, "friction");
  EXPECT_EQ(found.subject, "slope");
  ASSERT_FALSE(found.changes.empty());
  EXPECT_GT(found.changes.front().to, 0.45);
  EXPECT_LT(found.changes.front().to, 0.75) << "0.577 and a margin hold the robot on it for ever";
  ASSERT_FALSE(found.breaches.empty());
  EXPECT_THAT(found.breaches.front().subject, HasSubstr("_foot"));
}

TEST_F(DiagnosisTest, StopsWhenTheTimeIsUp) {
  const DiscreteProblem stiff =
      prepared(kCrouch, test::kHyqFile + "[limits.lh_kfe_joint]\nposition_rad = [1.4, 1.55]\n");
  const Diagnosis found = diagnose(stiff, RiccatiSolver(), IpoptSolver(), {.max_seconds = 1e-3});
  EXPECT_TRUE(found.out_of_time);
  EXPECT_FALSE(found.solvable);
  EXPECT_TRUE(found.kind.empty());
  EXPECT_THAT(diagnosis_text(found, stiff.problem), HasSubstr("the time was up before all changes were tried"));
}

/// The search has a part of the time, and what comes after it takes less than the rest.
TEST_F(DiagnosisTest, SaysThatASearchWasCutOff) {
  const DiscreteProblem high = prepared(test::replaced(kCrouch, "[0, 0, -0.1]", "[0, 0, 0.35]"));
  const RiccatiSolver solver;
  const ChangeSearch search(solver, {}, 1000.0);
  const std::vector<AdjustableParameter> parameters = adjustable_parameters(high.problem);
  const ChangesFound cut_off = search.within(0.0).smallest(parameters, high.mesh, {});
  EXPECT_TRUE(cut_off.out_of_time);
  EXPECT_EQ(cut_off.tried, 0);
  EXPECT_TRUE(cut_off.found.empty());
  const ChangesFound whole = search.smallest(parameters, high.mesh, {});
  EXPECT_FALSE(whole.out_of_time);
  EXPECT_EQ(whole.tried, static_cast<int>(parameters.size()));
  EXPECT_FALSE(whole.found.empty());
  EXPECT_TRUE(std::ranges::is_sorted(whole.found, std::less(), &FoundChange::weighted));
}

/// A change of something that has been solved would be a lie.
TEST_F(DiagnosisTest, OfWhatIsSolvedOnEachMeshNamesNoCause) {
  const DiscreteProblem crouch = prepared(kCrouch);
  for (const SolveStatus status : {SolveStatus::time_limit, SolveStatus::solver_failed}) {
    const Diagnosis found = diagnose(crouch, test::FailingSolver(1, status), IpoptSolver(), {});
    EXPECT_TRUE(found.solvable) << "a motion on its own mesh is at hand";
    EXPECT_EQ(found.status, status);
    EXPECT_FALSE(found.is_undecided());
    EXPECT_FALSE(found.out_of_time);
    EXPECT_TRUE(found.kind.empty());
    EXPECT_TRUE(found.changes.empty());
    EXPECT_FALSE(found.needs_one_mesh)
        << "eight intervals have no coarser mesh, and this one was seen not to be solved";
    EXPECT_THAT(diagnosis_headline(found, crouch.problem),
                AllOf(testing::StartsWith("the task has a plan (its mesh was solved from the initial guess), but "
                                          "prowl plan does not find it: "),
                      HasSubstr(status == SolveStatus::time_limit ? "time ran out after " : "optimal"),
                      HasSubstr("local integration error")))
        << "eight intervals are few";
    EXPECT_THAT(diagnosis_json(found, crouch.problem), HasSubstr("\"solvable\": true"));
  }
}

TEST_F(DiagnosisTest, NamesOneMeshWhereThatWasSeenToDo) {
  const DiscreteProblem crouch = prepared(test::replaced(kCrouch, "intervals = 8", "intervals = 60"));
  ASSERT_EQ(mesh_levels(crouch.problem, crouch.mesh).size(), 2u);
  constexpr int kSearch = 2;  // solves before, on 20 and 60 intervals
  constexpr int kPlan = 3;    // solves of the plan: on both, and again from a restored motion
  const Diagnosis found =
      diagnose(crouch, test::FailingSolver(kSearch, SolveStatus::solver_failed, kPlan), IpoptSolver(), {});
  EXPECT_TRUE(found.solvable);
  EXPECT_TRUE(found.needs_one_mesh);
  EXPECT_THAT(
      diagnosis_headline(found, crouch.problem),
      testing::StartsWith("the task has a plan with prowl plan --one-mesh, though none by way of coarse meshes, "));
  const Diagnosis neither =
      diagnose(crouch, test::FailingSolver(kSearch, SolveStatus::solver_failed), IpoptSolver(), {});
  EXPECT_TRUE(neither.solvable);
  EXPECT_FALSE(neither.needs_one_mesh);
  EXPECT_THAT(diagnosis_headline(neither, crouch.problem), HasSubstr("but prowl plan does not find it: "));
}

/// A task that takes longer than its part of the time may have a plan, whatever a coarse mesh says.
TEST_F(DiagnosisTest, OfATaskThatWasCutOffIsThatItIsNotKnown) {
  const DiscreteProblem weak = prepared(kCrouch, test::kWeakHyqFile);
  const Diagnosis found = diagnose(weak, test::FailingSolver(0, SolveStatus::time_limit), IpoptSolver(), {});
  EXPECT_TRUE(found.is_undecided());
  EXPECT_THAT(diagnosis_headline(found, weak.problem),
              AllOf(testing::StartsWith("not known whether the task has a plan, time ran out after "),
                    HasSubstr("on 8 mesh intervals phase 1 'crouch', "), HasSubstr("beyond its bound")));
  EXPECT_THAT(diagnosis_json(found, weak.problem), HasSubstr("\"solvable\": null"));
}

TEST_F(DiagnosisTest, GoesOnWithATaskThatWasCutOff) {
  std::vector<std::string> steps;
  const auto keep = [&](const std::string& what) { steps.push_back(what); };
  const test::FailingSolver solver(0, SolveStatus::time_limit, 2);
  const Diagnosis found = diagnose(prepared(kCrouch), solver, IpoptSolver(), {.on_step = keep});
  EXPECT_EQ(steps.back(), "planning the task, from where it stopped");
  const auto off = [&](const Eigen::VectorXd& guess) { return (guess - solver.ends[1]).lpNorm<Eigen::Infinity>(); };
  EXPECT_LT(off(solver.guesses.back()), 1e-3 * off(solver.guesses[1])) << "it began anew";
  EXPECT_TRUE(found.solvable);
  EXPECT_FALSE(found.is_undecided());
  EXPECT_TRUE(found.changes.empty()) << "found while it was thought to have no plan";
  EXPECT_TRUE(found.kind.empty());
}

TEST_F(DiagnosisTest, KeepsWhatWasFoundBeforeAnInterrupt) {
  const DiscreteProblem stiff =
      prepared(kCrouch, test::kHyqFile + "[limits.lh_kfe_joint]\nposition_rad = [1.4, 1.55]\n");
  std::atomic<bool> stop = false;
  DiagnosisOptions options;
  options.solver.interrupt = &stop;
  options.on_step = [&](const std::string& what) { stop = what.starts_with("elastic solve"); };
  const Diagnosis found = diagnose(stiff, RiccatiSolver(), IpoptSolver(), options);
  EXPECT_TRUE(found.interrupted);
  EXPECT_FALSE(found.changes.empty());
  EXPECT_THAT(diagnosis_text(found, stiff.problem),
              AllOf(HasSubstr("perhaps"), HasSubstr("interrupted before all changes were tried")));
}

/// On 28 intervals a walk is solved with feet that drift by centimetres; on its own mesh it is another motion.
TEST(ChangeSearch, TakesNoMotionInWhichFeetDrift) {
  const auto on_28 = [](const std::string& name) {
    const Task task = read_task_file(std::string(PROWL_SOURCE_DIR) + "/tasks/hyq/" + name + ".toml",
                                     test::test_search(), {.intervals = 28});
    return DiscreteProblem(task.problem, task.mesh);
  };
  const RiccatiSolver solver;
  const ChangeSearch search(solver, {}, 1000.0);
  EXPECT_TRUE(search.motion(on_28("crouch")));
  EXPECT_TRUE(search.solves(on_28("crouch")));
  EXPECT_TRUE(search.motion(on_28("walk")));
  EXPECT_FALSE(search.solves(on_28("walk")));
}

/// The limit of iterations is no property of the task.
TEST_F(DiagnosisTest, OfTooFewIterationsIsThatItIsNotKnown) {
  const DiscreteProblem weak = prepared(kCrouch, test::kWeakHyqFile);
  DiagnosisOptions options;
  options.solver.max_iterations = 2;
  EXPECT_THAT(diagnosis_headline(diagnose(weak, RiccatiSolver(), IpoptSolver(), options), weak.problem),
              testing::StartsWith("not known whether the task has a plan, stopped at solver.max_iterations (2); "));
  const Diagnosis found = diagnose(prepared(kCrouch), RiccatiSolver(), IpoptSolver(), options);
  EXPECT_TRUE(found.solvable) << "the search has iterations of its own";
  EXPECT_FALSE(found.needs_one_mesh) << "it has the same limit";
  EXPECT_THAT(diagnosis_headline(found, problem(kCrouch)),
              HasSubstr("but prowl plan does not find it: stopped at solver.max_iterations (2), but it fails "
                        "its certificate: "));
}

/// What a finer mesh has not shown is not said to be so.
TEST_F(DiagnosisTest, SaysPerhapsOfWhatIsNotProved) {
  const MotionProblem crouch = problem(kCrouch);
  Diagnosis found;
  found.task_intervals = found.search_intervals = 8;
  found.message = "stalled";
  const auto change = [](double to, bool passes) {
    return ProposedChange{
        .kind = "clearance", .from = 1.0, .to = to, .unit = "m", .amount = 1.0, .is_proved = passes, .passes = passes};
  };
  found.changes = {change(2.0, false)};
  EXPECT_EQ(diagnosis_headline(found, crouch),
            "not solved (stalled); perhaps solvable with swing clearance 2 m instead of 1 m");
  found.changes.push_back(change(3.0, true));
  EXPECT_EQ(diagnosis_headline(found, crouch),
            "not solved (stalled); solvable with swing clearance 3 m instead of 1 m, perhaps with swing clearance 2 m "
            "instead of 1 m");
  found.changes.back().passes = false;
  EXPECT_THAT(
      diagnosis_headline(found, crouch),
      HasSubstr("; solvable on a finer mesh (--refine) with swing clearance 3 m instead of 1 m, perhaps with "));
  found.changes.back().passes = true;
  found.changes.front().was_tried = true;
  EXPECT_THAT(diagnosis_text(found, crouch),
              HasSubstr("(solved from the initial guess, but the motion of prowl plan fails its certificate)"))
      << "8 are its own";
  found.task_intervals = 60;
  EXPECT_THAT(diagnosis_text(found, crouch), HasSubstr("(solved on 8 mesh intervals, but not on the task's own)"));
  found.task_intervals = 8;
  EXPECT_EQ(diagnosis_headline(found, crouch),
            "not solved (stalled); solvable with swing clearance 3 m instead of 1 m");
  found.changes.pop_back();
  EXPECT_EQ(diagnosis_headline(found, crouch),
            "not solved (stalled); no change of one number was found that makes it solvable on its own mesh");
  found.changes.push_back(change(3.0, true));
  found.changes.front().was_tried = false;
  EXPECT_THAT(
      diagnosis_text(found, crouch),
      AllOf(HasSubstr("  perhaps      with swing clearance 2 m instead of 1 m (solved on 8 mesh intervals only)\n"),
            HasSubstr("  solvable     with swing clearance 3 m instead of 1 m (this plan passes its certificate)\n")));
}

}  // namespace
}  // namespace prowl
