#include "screen/mesh_advice.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "prowl/task_file/task_file.hpp"
#include "screen/plan_summary.hpp"
#include "tests/support/test_files.hpp"

namespace prowl {
namespace {

using testing::HasSubstr;
using testing::Not;

/// Goals at 2/5 and the end of the first phase and at 2/3 of the second.
const std::string kTwoPhases = test::replaced(test::kTaskFile, "[start]", R"([[goal]]
time_s = 0.8
base_displacement_m = [0, 0, -0.05]
[[phase]]
name = "three"
contacts = ["lf_foot", "rf_foot", "lh_foot"]
duration_s = 0.3
intervals = 3
[[goal]]
phase = "three"
fraction = 0.66666667
base_displacement_m = ["free", "free", -0.05]
[start])");

class MeshAdvice : public testing::Test {
 protected:
  Task read(const TaskOverrides& overrides) const {
    return parse_task({"task.toml", kTwoPhases}, {"hyq.toml", test::kHyqFile}, test::test_search(), overrides);
  }
  /// A plan that converged with this largest integration error.
  PlanRecord record(double error, const TaskOverrides& overrides = {}) const {
    PlanRecord record{.task = read(overrides), .plan = {}, .versions = {}};
    record.plan.mesh = record.task.mesh;
    for (int i = 0; i < record.plan.mesh.num_intervals(); ++i)
      record.plan.certificate.interval_errors.push_back({0.0, 0.1, 1e-9, "v"});
    record.plan.certificate.interval_errors[3].error = error;
    record.plan.result.status = SolveStatus::converged;
    return record;
  }
  /// The N of "--intervals N" after "for grade GRADE"; 0 if there is none.
  static int advised(const std::string& text, const std::string& grade) {
    const std::size_t line = text.find("for grade " + grade);
    const std::string option = "--intervals ";
    if (line == std::string::npos || text.find(option, line) == std::string::npos) return 0;
    return std::stoi(text.substr(text.find(option, line) + option.size()));
  }
};

TEST_F(MeshAdvice, IsTheSmallestNumberThatIsEnoughAndKeepsTheGoalsAtNodes) {
  for (const TaskOverrides& overrides : {TaskOverrides{}, TaskOverrides{.intervals = 40}}) {
    const PlanRecord plan = record(5e-4, overrides);
    const auto intervals = static_cast<double>(plan.plan.certificate.interval_errors.size());
    for (const auto& [grade, goal] : {std::pair{"draft", 1e-4}, std::pair{"certified", 1e-6}}) {
      const double needed = intervals * std::cbrt(1.25 * 5e-4 / goal);
      const int option = advised(mesh_advice(plan), grade);
      ASSERT_GE(option, needed) << mesh_advice(plan);
      EXPECT_NO_THROW(read({.intervals = option}));
      for (int less = option - 1; less >= needed; --less) EXPECT_THROW(read({.intervals = less}), InputError) << less;
    }
  }
}

TEST_F(MeshAdvice, SpeaksOfWhatIsMissingOnly) {
  EXPECT_EQ(advised(mesh_advice(record(5e-5)), "draft"), 0);
  EXPECT_GT(advised(mesh_advice(record(5e-5)), "certified"), 8);
  EXPECT_EQ(mesh_advice(record(5e-7)), "");
  EXPECT_THAT(mesh_advice(record(1e9)),
              HasSubstr("for grade draft (0.0001) about more than 10000 intervals, or --refine draft\n"));
}

/// Of steps that differ, or of a corrected motion, no number of equal steps of the trapezoid follows.
TEST_F(MeshAdvice, OfARefinedPlanIsToRefineIt) {
  PlanRecord uneven = record(5e-5), corrected = record(5e-5);
  uneven.plan.mesh.phases[0] = PhaseMesh({1.0, 1.0, 1.0, 1.0, 2.0});
  corrected.plan.trajectory.interpolation = Interpolation::hermite;
  for (const PlanRecord* plan : {&uneven, &corrected}) {
    EXPECT_THAT(mesh_advice(*plan),
                testing::EndsWith("intervals:\nfor grade certified (1e-06) --refine certified --warm-start with the "
                                  "folder of this plan\n"));
  }
}

TEST_F(MeshAdvice, SaysNothingOfAPlanThatDidNotConverge) {
  PlanRecord plan = record(5e-4);
  plan.plan.result.status = SolveStatus::iteration_limit;
  EXPECT_EQ(mesh_advice(plan), "");
}

TEST_F(MeshAdvice, SaysNothingWhereAFinerMeshWouldNotDo) {
  PlanRecord plan = record(5e-4);
  plan.plan.certificate.checks = {{"local integration error", 5e-4, 1e-4, "", 0.2, "v", false},
                                  {"joint torque", 1.0, 1.0, "of limit", 0.2, "", true}};
  EXPECT_NE(mesh_advice(plan), "");
  plan.plan.certificate.checks[1].passed = false;
  EXPECT_EQ(mesh_advice(plan), "");
}

TEST(CertificateSummary, RepeatsTheFailedChecksAtTheEnd) {
  Certificate certificate;
  certificate.checks = {{"contact drift", 1e-5, 1e-3, "m", 0.1, "lf_foot", true},
                        {"local integration error", 1.84e-4, 1e-4, "", 0.2, "", false},
                        {"joint torque", 2.0, 1.0, "of limit", 0.2, "", false}};
  EXPECT_THAT(
      certificate_summary(certificate),
      testing::EndsWith("\nfailed: local integration error (0.000184 > 0.0001), joint torque (2 > 1 of limit)\n"));
  certificate.checks.resize(1);
  EXPECT_THAT(certificate_summary(certificate), Not(HasSubstr("failed: ")));
}

}  // namespace
}  // namespace prowl
