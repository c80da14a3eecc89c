// Every shipped task, planned and then run in MuJoCo by the command: it keeps all criteria of the judge, or it is
// listed here with what it fails by.
#include <gmock/gmock.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "tests/support/test_files.hpp"

namespace prowl {
namespace {

const std::filesystem::path kTasks = std::filesystem::path(PROWL_SOURCE_DIR) / "tasks";

/// docs/simulated-tasks.md tells why.
const std::map<std::string, std::string> kFailing = {
    {"hyq/rear", "torque"},
    {"hyq/wall", "base"},
};

std::vector<std::string> shipped_tasks() {
  std::vector<std::string> tasks;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(kTasks)) {
    const std::filesystem::path task = entry.path().lexically_relative(kTasks);
    if (task.extension() == ".toml" && *task.begin() != "paper") tasks.push_back(task.parent_path() / task.stem());
  }
  std::ranges::sort(tasks);
  return tasks;
}

class SimulatedTask : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override { ASSERT_EQ(run("plan '" + (kTasks / GetParam()).string() + ".toml' --out" + out_), 0); }
  int run(const std::string& arguments) const {
    const std::string dirs = " --package-dir " PROWL_ROBOTS_DATA;
    return WEXITSTATUS(std::system((PROWL_COMMAND " " + arguments + dirs + " >/dev/null 2>&1").c_str()));
  }
  nlohmann::json simulated(int seed) const {
    std::filesystem::remove(folder_.path() / "out/simulate.json");
    EXPECT_THAT(run("simulate --seed " + std::to_string(seed) + out_), testing::AnyOf(0, 8));
    return nlohmann::json::parse(test::read_file(folder_.path() / "out/simulate.json"));
  }

  test::TempFolder folder_;
  std::string out_ = " '" + (folder_.path() / "out").string() + "'";
};

/// With noise, estimator and delay; without feedback it does not.
TEST_P(SimulatedTask, SucceedsAndNeedsItsGains) {
  const auto failing = kFailing.find(GetParam());
  std::string failures;
  for (int seed = 1; seed <= (failing == kFailing.end() ? 2 : 5); ++seed) {
    const nlohmann::json json = simulated(seed);
    EXPECT_GT(json.at("estimated_position_m").at("largest"), 1e-5) << "the controller saw the truth";
    if (json.at("success") == false) failures += json.at("failures").dump();
  }
  if (failing != kFailing.end()) {
    EXPECT_THAT(failures, testing::HasSubstr(failing->second)) << "it succeeds now: take it off the list";
    return;
  }
  EXPECT_EQ(failures, "");
  EXPECT_EQ(run("simulate --open-loop" + out_), 8);
}

INSTANTIATE_TEST_SUITE_P(All, SimulatedTask, testing::ValuesIn(shipped_tasks()), [](const auto& info) {
  std::string name = info.param;
  std::ranges::replace(name, '/', '_');
  return name;
});

TEST(SimulatedTasks, AreAllThatAreShipped) {
  EXPECT_EQ(shipped_tasks().size(), 27u);
  for (const auto& [task, failure] : kFailing) EXPECT_THAT(shipped_tasks(), testing::Contains(task));
}

}  // namespace
}  // namespace prowl
