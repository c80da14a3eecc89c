#include "prowl/diagnosis/diagnosis.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "prowl/diagnosis/change_search.hpp"
#include "prowl/io/diagnosis_report.hpp"
#include "prowl/solvers/ipopt_solver.hpp"
#include "prowl/solvers/riccati_solver.hpp"
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
  static Diagnosis diagnosis(const MotionProblem& problem) { return diagnose(problem, RiccatiSolver(), IpoptSolver(), {}); }
};

TEST_F(DiagnosisTest, OfATaskWithAPlanIsThatItHasOne) {
  std::vector<std::string> steps;
  const auto keep = [&](const std::string& what) { steps.push_back(what); };
  const Diagnosis found = diagnose(problem(kCrouch), RiccatiSolver(), IpoptSolver(), {.on_step = keep});
  EXPECT_THAT(steps, testing::ElementsAre("solving as it is, 8 intervals", "planning as it is")) << "a small mesh is solved once";
  EXPECT_TRUE(found.solvable);
  EXPECT_TRUE(found.kind.empty());
  EXPECT_TRUE(found.changes.empty());
}

/// A mesh too coarse is no matter of the task, and needs no search.
TEST_F(DiagnosisTest, OfAPlanThatFailsItsCertificateNamesTheChecks) {
  const MotionProblem coarse = problem(kCrouch);
  const Diagnosis found = diagnosis(coarse);
  EXPECT_TRUE(found.solvable);
  EXPECT_FALSE(found.certificate.passed);
  EXPECT_THAT(diagnosis_headline(found, coarse), AllOf(HasSubstr("fails its certificate: local integration error ("), HasSubstr(" > 0.0001"),
                                                       testing::EndsWith("; its mesh is too coarse: prowl plan --refine")));
}

TEST_F(DiagnosisTest, NamesTheJointThatMayNotBend) {
  const MotionProblem stiff = problem(kCrouch, test::kHyqFile + "[limits.lh_kfe_joint]\nposition_rad = [1.4, 1.55]\n");
  const Diagnosis found = diagnosis(stiff);
  EXPECT_FALSE(found.solvable);
  EXPECT_EQ(found.kind, "joint_position");
  EXPECT_EQ(found.subject, "lh_kfe_joint");
  ASSERT_FALSE(found.breaches.empty());
  const Breach& breach = found.breaches.front();
  EXPECT_EQ(breach.subject, "lh_kfe_joint");
  EXPECT_EQ(breach.time, 1.0);
  ASSERT_FALSE(found.changes.empty());
  const Change& change = found.changes.front();
  EXPECT_NEAR(change.from, 0.15, 1e-12);
  EXPECT_NEAR(0.5 * (change.to - change.from), breach.amount, 0.05) << "two ways to the same: a range wider on both sides";
  EXPECT_THAT(diagnosis_headline(found, stiff), AllOf(HasSubstr("phase 1 'crouch', lh_kfe_joint, joint position at 1 s: "),
                                                      HasSubstr("rad beyond its bound; solvable with position range of lh_kfe_joint")));
}

TEST_F(DiagnosisTest, NamesWeakJoints) {
  const MotionProblem weak = problem(kCrouch, test::kWeakHyqFile);
  const Diagnosis found = diagnosis(weak);
  EXPECT_EQ(found.kind, "torque") << diagnosis_text(found, weak);
  EXPECT_THAT(found.subject, AllOf(HasSubstr("f_kfe_joint"), testing::Not(HasSubstr("haa")), testing::Not(HasSubstr("lh_kfe"))));
}

TEST_F(DiagnosisTest, OfASlopeNamesFrictionAndHowMuchIsNeeded) {
  const MotionProblem slope = problem("robot = \"hyq.toml\"\n[[surface]]\nname = \"slope\"\nnormal = [-0.5, 0, 0.8660254]\nfriction = 0.4\n"
                                      "[start]\non = \"slope\"\n" + test::replaced(test::replaced(kCrouch, "robot = \"hyq.toml\"\n", ""),
                                      "base_rpy_rad = [0, 0, 0]\n", ""));
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
  const MotionProblem stiff = problem(kCrouch, test::kHyqFile + "[limits.lh_kfe_joint]\nposition_rad = [1.4, 1.55]\n");
  const Diagnosis found = diagnose(stiff, RiccatiSolver(), IpoptSolver(), {.max_seconds = 1e-3});
  EXPECT_TRUE(found.out_of_time);
  EXPECT_FALSE(found.solvable);
  EXPECT_TRUE(found.kind.empty());
  EXPECT_THAT(diagnosis_text(found, stiff), HasSubstr("the time is up"));
}

/// The search has a part of the time, and what comes after it takes less than the rest.
TEST_F(DiagnosisTest, SaysThatASearchWasCutOff) {
  const MotionProblem high = problem(test::replaced(kCrouch, "[0, 0, -0.1]", "[0, 0, 0.35]"));
  const RiccatiSolver solver;
  const ChangeSearch search(solver, {}, 1000.0);
  const std::vector<Knob> knobs = knobs_of(high);
  const ChangesFound cut_off = search.smallest(knobs, 0.0, {});
  EXPECT_TRUE(cut_off.out_of_time);
  EXPECT_EQ(cut_off.tried, 0);
  EXPECT_TRUE(cut_off.found.empty());
  const ChangesFound whole = search.smallest(knobs, 1000.0, {});
  EXPECT_FALSE(whole.out_of_time);
  EXPECT_EQ(whole.tried, static_cast<int>(knobs.size()));
  EXPECT_FALSE(whole.found.empty());
  EXPECT_TRUE(std::ranges::is_sorted(whole.found, std::less(), &FoundChange::weighted));
}

/// A change of something that has been solved would be a lie.
TEST_F(DiagnosisTest, OfWhatIsSolvedOnEachMeshNamesNoCause) {
  const MotionProblem crouch = problem(kCrouch);
  for (const SolveStatus status : {SolveStatus::time_limit, SolveStatus::solver_failed}) {
    const Diagnosis found = diagnose(crouch, test::FailingSolver(1, status), IpoptSolver(), {});
    EXPECT_FALSE(found.solvable);
    EXPECT_EQ(found.status, status);
    EXPECT_EQ(found.out_of_time, status == SolveStatus::time_limit);
    EXPECT_TRUE(found.kind.empty());
    EXPECT_TRUE(found.changes.empty());
    EXPECT_THAT(diagnosis_headline(found, crouch), HasSubstr("though each of its meshes is, from the initial guess"));
  }
}

}  // namespace
}  // namespace prowl
