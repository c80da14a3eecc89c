// Every shipped HyQ task on level ground, planned and then run in MuJoCo by the command: all end in rest.
#include <gmock/gmock.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "tests/support/test_files.hpp"

namespace prowl {
namespace {

const std::filesystem::path kTasks = std::filesystem::path(PROWL_SOURCE_DIR) / "tasks/hyq";

/// Not on level ground; docs/simulation.md tells how they fall.
const std::set<std::string> kElsewhere = {"slope", "wall"};

std::vector<std::string> tasks_on_level_ground() {
  std::vector<std::string> tasks;
  for (const auto& entry : std::filesystem::directory_iterator(kTasks)) {
    const std::string task = entry.path().stem().string();
    if (entry.path().extension() == ".toml" && !kElsewhere.contains(task)) tasks.push_back(task);
  }
  std::ranges::sort(tasks);
  return tasks;
}

class SimulatedTask : public testing::TestWithParam<std::string> {};

/// With noise, estimator and delay, by the criteria of the task; without feedback none of them.
TEST_P(SimulatedTask, SucceedsAndNeedsItsGains) {
  const test::TempFolder folder;
  const std::string out = " '" + (folder.path() / "out").string() + "'", dirs = " --package-dir " PROWL_ROBOTS_DATA;
  const auto run = [&](const std::string& arguments) {
    return WEXITSTATUS(std::system((PROWL_COMMAND " " + arguments + dirs + " >/dev/null 2>&1").c_str()));
  };
  ASSERT_EQ(run("plan '" + (kTasks / GetParam()).string() + ".toml' --out" + out), 0);
  for (const char* seed : {"1", "2"}) {
    EXPECT_EQ(run(std::string("simulate --seed ") + seed + out), 0);
    const auto json = nlohmann::json::parse(test::read_file(folder.path() / "out/simulate.json"));
    EXPECT_EQ(json.at("success"), true) << json.at("failures");
    EXPECT_LT(json.at("base_position_m").at("rest"), 0.02);
    EXPECT_LT(json.at("base_angle_rad").at("rest"), 0.035);
    EXPECT_GT(json.at("estimated_position_m").at("largest"), 1e-5) << "the controller saw the truth";
  }
  EXPECT_EQ(run("simulate --open-loop" + out), 8);
}

INSTANTIATE_TEST_SUITE_P(HyQ, SimulatedTask, testing::ValuesIn(tasks_on_level_ground()),
                         [](const auto& info) { return info.param; });

TEST(SimulatedTasks, AreAllButTheTwoElsewhere) {
  for (const std::string& task : kElsewhere) EXPECT_TRUE(std::filesystem::exists(kTasks / (task + ".toml"))) << task;
  EXPECT_THAT(tasks_on_level_ground(), testing::IsSupersetOf({"stand", "crouch", "rear", "balance", "step", "walk",
                                                              "trot", "hold", "jump", "kneel"}));
}

}  // namespace
}  // namespace prowl
