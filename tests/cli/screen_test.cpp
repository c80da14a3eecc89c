// What is printed at the end fits a screen of 80 columns and 24 rows.
#include <gmock/gmock.h>

#include "command.hpp"

namespace prowl {
namespace {

using testing::HasSubstr;

class Screen : public test::Command {
 protected:
  Screen() { run("ln -s '" PROWL_SOURCE_DIR "/tasks' '" PROWL_SOURCE_DIR "/robots' ."); }
  void expect_fit(const std::string& command, int rows) const {
    const std::string text = run(command + " $dirs").out;
    std::istringstream lines(text);
    int count = 0;
    for (std::string line; std::getline(lines, line); ++count) {
      const bool one_word =
          line.find(' ', line.find_first_not_of(' ')) == std::string::npos || line.starts_with("  URDF /");
      if (!one_word) EXPECT_LE(line.size(), 80u) << command << "\n" << line;
    }
    EXPECT_GT(count, 10) << command << ": nothing to look at";
    EXPECT_LE(count, rows) << text;
  }
};

TEST_F(Screen, HasRoomForAPlan) {
  expect_fit("$prowl plan tasks/hyq/crouch.toml --out out/crouch", 23);
  expect_fit("$prowl plan tasks/talos/squat.toml --out out/squat --intervals 34", 23);
}

TEST_F(Screen, HasRoomForAPlanThatFails) {
  expect_fit("$prowl plan tasks/hyq/walk.toml --out out/walk --intervals 94", 23);
  expect_fit("$prowl plan tasks/hyq/crouch.toml --out out/crouch --max-iterations 1", 23);
}

TEST_F(Screen, HasRoomForARobotAndASimulation) {
  expect_fit("$prowl robot robots/hyq.toml", 23);
  ASSERT_EQ(run("$prowl plan hold.toml --out out $dirs").status, 0);
  expect_fit("$prowl simulate out", 23);
  expect_fit("$prowl simulate out --engine rollout", 23);
}

// What fails has to be among the checks that are shown, and the way to all of them.
TEST_F(Screen, ShowsWhatFails) {
  const std::string plan = run("$prowl plan tasks/hyq/crouch.toml --intervals 10 --out out/crouch $dirs").out;
  const std::string all = run("$prowl check out/crouch $dirs").out;
  std::istringstream lines(all);
  int failed = 0;
  for (std::string line; std::getline(lines, line);) {
    if (!line.ends_with("FAIL")) continue;
    ++failed;
    const std::string name = line.substr(2, line.find("  ", 2) - 2);
    const std::size_t row = plan.find("\n  " + name + "  ");
    EXPECT_NE(row, std::string::npos) << name << plan;
    EXPECT_THAT(plan.substr(row + 1, plan.find('\n', row + 1) - row - 1), testing::EndsWith("FAIL"));
  }
  EXPECT_GT(failed, 0) << all;
  EXPECT_THAT(plan, HasSubstr("checks: prowl check out/crouch\n"));
}

}  // namespace
}  // namespace prowl
