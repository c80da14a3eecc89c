// Every task of the repository, planned from its file alone by the command: the motions that Prowl promises.
#include <gmock/gmock.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>

#include "tests/support/test_files.hpp"
#include "tests/tasks/purposes.hpp"

namespace prowl {
namespace {

using test::misses_of;
using test::test_search;
using testing::IsEmpty;
using testing::Not;

const std::filesystem::path kTasks = std::filesystem::path(PROWL_SOURCE_DIR) / "tasks";

/// robot/motion of every task, in order. Those of tasks/paper have the paper's meshes, which are too coarse for the
/// certificate: tests/scripts/paper_test.py has them.
std::vector<std::string> shipped_tasks() {
  std::vector<std::string> tasks;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(kTasks)) {
    if (entry.path().extension() != ".toml" || entry.path().parent_path().filename() == "paper") continue;
    tasks.push_back(std::filesystem::relative(entry.path(), kTasks).replace_extension().string());
  }
  std::ranges::sort(tasks);
  return tasks;
}

struct Planned {
  int status = -1;
  nlohmann::json plan;

  const nlohmann::json& check(const std::string& name) const {
    const auto& checks = plan.at("certificate").at("checks");
    const auto found = std::ranges::find_if(checks, [&](const auto& check) { return check.at("name") == name; });
    if (found == checks.end()) throw std::logic_error("the certificate has no check '" + name + "'");
    return *found;
  }
};

Planned plan(const std::string& task, const std::string& options, const test::TempFolder& folder) {
  const std::filesystem::path out = folder.path() / "out";
  const std::string command = std::string("'" PROWL_COMMAND "' plan '") + (kTasks / (task + ".toml")).string() + "' " +
                              options + " --package-dir '" PROWL_ROBOTS_DATA "' --out '" + out.string() +
                              "' >/dev/null 2>&1";
  Planned planned;
  planned.status = WEXITSTATUS(std::system(command.c_str()));
  planned.plan = nlohmann::json::parse(test::read_file(out / "plan.json"));
  return planned;
}

/// What the feedback may leave of a deviation at the start: of Talos more, whose arms are slow.
double most_left(const std::string& task) {
  const std::map<std::string, double> talos{{"talos/squat", 0.4}, {"talos/step", 0.1}, {"talos/weight_shift", 0.01}};
  const auto found = talos.find(task);
  return found == talos.end() ? 1e-3 : found->second;
}

/// The motion q with each q ⊖ start taken `factor` times: 0 stays where it starts, -1 goes the other way.
test::PlannedTask scaled(test::PlannedTask motion, double factor) {
  const Eigen::VectorXd start = motion.start().q;
  for (TrajectoryPoint& node : motion.nodes()) {
    node.q = integrate(start, factor * difference(start, node.q));
    node.v *= factor;
  }
  return motion;
}

class ShippedTask : public testing::TestWithParam<std::string> {
 protected:
  test::TempFolder folder_;
};

TEST_P(ShippedTask, ConvergesAndIsWhatTheCertificateSays) {
  const Planned planned = plan(GetParam(), "", folder_);
  EXPECT_EQ(planned.plan.at("status"), "converged");
  EXPECT_EQ(planned.status, 0);
  EXPECT_EQ(planned.plan.at("certificate").at("passed"), true);
  EXPECT_LT(planned.check("contact drift").at("worst"), 1e-3);
  const nlohmann::json& tracking = planned.plan.at("tracking");
  ASSERT_FALSE(tracking.is_null()) << "no gains";
  EXPECT_TRUE(tracking.at("stands_on"));
  EXPECT_LT(tracking.at("whole").at("worst"), most_left(GetParam())) << "what is left of a deviation at the start";

  const test::PlannedTask motion(kTasks / (GetParam() + ".toml"), read_plan(folder_.path() / "out", test_search()));
  EXPECT_THAT(misses_of(GetParam(), motion), IsEmpty());
  if (GetParam() == "hyq/hold") return;  // which is done by doing nothing
  EXPECT_THAT(misses_of(GetParam(), scaled(motion, 0.0)), Not(IsEmpty())) << "standing still would do";
  EXPECT_THAT(misses_of(GetParam(), scaled(motion, -1.0)), Not(IsEmpty())) << "the other way would do";
}

INSTANTIATE_TEST_SUITE_P(All, ShippedTask, testing::ValuesIn(shipped_tasks()), [](const auto& info) {
  std::string name = info.param;
  std::ranges::replace(name, '/', '_');
  return name;
});

TEST(ShippedTasks, AreThoseOfFiveRobotsAndHaveAPurpose) {
  const std::vector<std::string> tasks = shipped_tasks();
  std::vector<std::string> with_purpose;
  for (const auto& [task, purpose] : test::kPurposes) with_purpose.push_back(task);
  EXPECT_EQ(tasks, with_purpose);
  for (const char* task :
       {"hyq/hold",    "hyq/stand",          "hyq/crouch",     "hyq/balance",     "hyq/step",      "hyq/rear",
        "hyq/slope",   "hyq/wall",           "hyq/kneel",      "hyq/walk",        "hyq/trot",      "hyq/jump",
        "go2/trot",    "solo12/trot",        "anymal_c/stand", "anymal_c/crouch", "anymal_c/step", "anymal_c/trot",
        "go2/stand",   "go2/crouch",         "go2/step",       "solo12/stand",    "solo12/crouch", "solo12/step",
        "talos/squat", "talos/weight_shift", "talos/step"}) {
    EXPECT_THAT(tasks, testing::Contains(task));
  }
}

/// The six nodes of the paper: said to be too few.
TEST(ShippedTasks, hyqStandFailsWithSixNodes) {
  const test::TempFolder folder;
  const Planned planned = plan("hyq/stand", "--intervals 5", folder);
  EXPECT_EQ(planned.plan.at("status"), "converged");
  EXPECT_EQ(planned.status, 7);
  EXPECT_EQ(planned.plan.at("certificate").at("grade"), "failed");
  EXPECT_EQ(planned.check("local integration error").at("passed"), false);
}

/// The order of the transcribed motion: half the step, an eighth of the integration error of an interval.
TEST(ShippedTasks, hyqCrouchIsOfThirdOrder) {
  const test::TempFolder folder;
  const auto error = [&](const char* intervals) {
    const Planned planned = plan("hyq/crouch", std::string("--max-iterations 100 --intervals ") + intervals, folder);
    return planned.check("local integration error").at("worst").get<double>();
  };
  EXPECT_GT(error("40") / error("80"), 6.5);
}

}  // namespace
}  // namespace prowl
