#include "prowl/batch/job.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "prowl/batch/job_file.hpp"
#include "prowl/error.hpp"
#include "tests/support/robots.hpp"
#include "tests/support/test_files.hpp"

namespace prowl {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

constexpr int kMany = 4000;

Job job_of(const std::string& text) {
  return read_job_text({"/jobs/job.toml", text}, std::string(PROWL_SOURCE_DIR) + "/tasks");
}

std::string complaint(const std::string& text, bool checks_draws = false) {
  try {
    const Job job = job_of(text);
    if (checks_draws) check_draws(job, [](const SourceText& task) { read_task_text(task, test::test_search()); });
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

const std::string kHead = "task = \"hyq/crouch\"\ncount = 4000\n";
const std::string kDepth = "[[draw]]\nkey = \"goal[0].base_displacement_m[2]\"\n";

double number(const Job& job, int index) { return std::get<double>(drawn_values(job, index)[0]); }

TEST(Job, HasDefaults) {
  const Job job = job_of(kHead);
  EXPECT_EQ(job.count, 4000);
  EXPECT_EQ(job.seed, 1u);
  EXPECT_EQ(job.grade, CertificateGrade::draft);
  EXPECT_FALSE(job.gains || job.simulation);
  EXPECT_EQ(drawn_values(job, 0).size(), 0u);
  EXPECT_THAT(job.task_file.path.string(), testing::EndsWith("tasks/hyq/crouch.toml"));
}

TEST(Draw, HasItsDistribution) {
  const auto moments = [](const std::string& distribution) {
    const Job job = job_of(kHead + kDepth + distribution);
    double sum = 0.0, squares = 0.0;
    for (int i = 0; i < kMany; ++i) sum += number(job, i);
    const double mean = sum / kMany;
    for (int i = 0; i < kMany; ++i) squares += std::pow(number(job, i) - mean, 2);
    return std::pair(mean, std::sqrt(squares / kMany));
  };
  const auto [even_mean, even_deviation] = moments("uniform = [-0.2, -0.1]\n");
  EXPECT_NEAR(even_mean, -0.15, 0.002);
  EXPECT_NEAR(even_deviation, 0.1 / std::sqrt(12.0), 0.002);
  const auto [normal_mean, normal_deviation] = moments("normal = [-0.1, 0.02]\n");
  EXPECT_NEAR(normal_mean, -0.1, 0.002);
  EXPECT_NEAR(normal_deviation, 0.02, 0.001);
  const Job logarithmic = job_of(kHead + kDepth + "log_uniform = [0.01, 1.0]\n");
  int below = 0;
  for (int i = 0; i < kMany; ++i) below += number(logarithmic, i) < 0.1;
  EXPECT_NEAR(below, kMany / 2, 150);
}

TEST(Draw, StaysWithinItsEnds) {
  const Job job = job_of(kHead + kDepth + "normal = [1.0, 0.1]\n");
  for (int i = 0; i < kMany; ++i) EXPECT_LE(std::abs(number(job, i) - 1.0), 0.3);
}

/// By job and index alone: neither another count nor another draw changes a value.
TEST(Draw, DependsOnSeedAndIndexAlone) {
  const std::string depth = kDepth + "uniform = [-0.2, -0.1]\n";
  const Job job = job_of(kHead + depth);
  const Job more =
      job_of("task = \"hyq/crouch\"\ncount = 9\n" + depth + "[[draw]]\nkey = \"name\"\none_of = [\"a\", \"b\"]\n");
  const Job other = job_of("seed = 2\n" + kHead + depth);
  for (int i = 0; i < 9; ++i) {
    EXPECT_EQ(number(job, i), number(more, i));
    EXPECT_NE(number(job, i), number(other, i));
    EXPECT_NE(number(job, i), number(job, i + 1));
  }
  EXPECT_EQ(number(job, 7), number(job, 7));
}

/// The same on every machine: libraries name motions by their index.
TEST(Draw, IsTheSameForever) {
  const Job job = job_of(kHead + kDepth + "uniform = [0.0, 1.0]\n");
  EXPECT_DOUBLE_EQ(number(job, 0), 0.41808401466254635);
  EXPECT_DOUBLE_EQ(number(job, 1000), 0.61852914226612432);
}

TEST(Draw, ReachesTheTask) {
  const Job job = job_of(kHead + kDepth +
                         "uniform = [-0.2, -0.1]\n[[draw]]\nkey = [\"cost.torque\", \"cost.joint_velocity\"]\n"
                         "one_of = [0.5, 0.25]\n");
  const Task task = read_task_text({job.task_file.path, drawn_task_text(job, 5)}, test::test_search());
  const std::vector<DrawnValue> values = drawn_values(job, 5);
  const double height = task.problem.boundary_constraints[1].q_ref(2) - task.problem.start_configuration()(2);
  EXPECT_NEAR(height, std::get<double>(values[0]), 1e-12);
  EXPECT_DOUBLE_EQ(task.problem.running_cost.torque_weight(0), std::get<double>(values[1]));
}

TEST(Job, NamesMistakesWithTheirPlace) {
  EXPECT_THAT(complaint("task = \"hyq/crouch\"\ncuont = 3\n"),
              AllOf(StartsWith("/jobs/job.toml:2:1: cuont: "), HasSubstr("'count'")));
  EXPECT_THAT(complaint("task = \"hyq/crouch\"\n"), HasSubstr("count"));
  EXPECT_THAT(complaint("task = \"hyq/crounch\"\ncount = 1\n"), StartsWith("/jobs/job.toml:1:8: task: "));
  EXPECT_THAT(complaint("task = \"hyq/crouch\"\ncount = 0\n"), StartsWith("/jobs/job.toml:2:9: count: "));
  EXPECT_THAT(complaint(kHead + kDepth),
              HasSubstr("no distribution; need one of uniform, log_uniform, normal, one_of"));
  EXPECT_THAT(complaint(kHead + kDepth + "uniform = [1, 1]\n"),
              AllOf(HasSubstr(":5:11: "), HasSubstr("is an empty range")));
  EXPECT_THAT(complaint(kHead + kDepth + "uniform = [1, 2, 3]\n"), HasSubstr("a list of 3"));
  EXPECT_THAT(complaint(kHead + kDepth + "log_uniform = [0, 1]\n"), HasSubstr("log_uniform"));
  EXPECT_THAT(complaint(kHead + kDepth + "normal = [0, -1]\n"), HasSubstr("need a standard deviation > 0"));
  EXPECT_THAT(complaint(kHead + kDepth + "one_of = []\n"), HasSubstr("need one value or more"));
  EXPECT_THAT(complaint(kHead + kDepth + "one_of = [1, \"a\"]\n"), HasSubstr("values of several types"));
  EXPECT_THAT(complaint(kHead + kDepth + "uniform = [0, 1]\nnormal = [0, 1]\n"),
              HasSubstr("need one in each [[draw]]"));
  EXPECT_THAT(complaint(kHead + kDepth + "uniform = [0, 1]\n" + kDepth + "uniform = [0, 1]\n"),
              HasSubstr("is drawn twice"));
  EXPECT_THAT(complaint("[[phase]]\ncontacts = \"all\"\n"), HasSubstr("looks like a task file"));
}

TEST(Job, FindsDrawsThatTheTaskRefuses) {
  const auto said = [](const std::string& draw) { return complaint(kHead + "[[draw]]\n" + draw, true); };
  EXPECT_EQ(said("key = \"goal[0].base_displacement_m[2]\"\nuniform = [-0.2, -0.1]\n"), "");
  EXPECT_THAT(said("key = \"goal[5].time_s\"\nuniform = [0.5, 1]\n"),
              AllOf(StartsWith("/jobs/job.toml:4:7: draw[0].key: "), HasSubstr("has no goal[5]")));
  EXPECT_THAT(said("key = \"goal[0].time_z\"\nuniform = [0.5, 1]\n"), HasSubstr("'time_s'"));
  EXPECT_THAT(said("key = \"goal[0].time_s\"\nuniform = [0.5, 7]\n"), HasSubstr("with the value 7"));
  EXPECT_THAT(said("key = \"surface[0].friction\"\nuniform = [-1, 1]\n"), HasSubstr("with the value -1"));
}

}  // namespace
}  // namespace prowl
