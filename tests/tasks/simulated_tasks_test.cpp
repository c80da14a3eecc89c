// Every shipped HyQ task that ends in rest on level ground, planned and then run in MuJoCo by the command.
#include <gmock/gmock.h>
#include <sys/wait.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "../io/test_files.hpp"

namespace prowl {
namespace {

class SimulatedTask : public testing::TestWithParam<const char*> {};

/// With noise, estimator and delay, by the criteria of the task; without feedback none of them.
TEST_P(SimulatedTask, SucceedsAndNeedsItsGains) {
  const test::TempFolder folder;
  const std::string out = " '" + (folder.path() / "out").string() + "'", dirs = " --package-dir " PROWL_ROBOTS_DATA;
  const auto run = [&](const std::string& arguments) {
    return WEXITSTATUS(std::system((PROWL_COMMAND " " + arguments + dirs + " >/dev/null 2>&1").c_str()));
  };
  ASSERT_EQ(run("plan " PROWL_SOURCE_DIR "/tasks/hyq/" + std::string(GetParam()) + ".toml --out" + out), 0);
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

INSTANTIATE_TEST_SUITE_P(HyQ, SimulatedTask,
                         testing::Values("stand", "crouch", "rear", "balance", "step", "walk", "trot"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace prowl
