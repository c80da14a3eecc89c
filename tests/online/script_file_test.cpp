#include "prowl/online/script_file.hpp"

#include <gmock/gmock.h>

#include "prowl/error.hpp"
#include "prowl/online/random_events.hpp"
#include "tests/support/robots.hpp"

namespace prowl {
namespace {

using testing::HasSubstr;

Script script_of(const std::string& text) { return read_script({"walk.toml", text}); }

std::string complaint(const std::string& text) {
  try {
    script_of(text);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(ScriptFile, HasCommandsInTheOrderOfTimeAndPushes) {
  const Script script = script_of(
      "[[command]]\ntime_s = 4\ngait = \"stand\"\n"
      "[[command]]\ntime_s = 1\nvelocity_mps = [0.3, -0.1]\nturn_radps = 0.2\nheight_m = -0.02\n"
      "[[push]]\ntime_s = 2.5\nimpulse_Ns = [1, 2, 3]\n");
  ASSERT_EQ(script.commands.size(), 2u);
  EXPECT_EQ(script.commands[0].time, 1.0);
  EXPECT_EQ(script.commands[0].command.forward, 0.3);
  EXPECT_EQ(script.commands[0].command.left, -0.1);
  EXPECT_EQ(script.commands[0].command.turn, 0.2);
  EXPECT_EQ(script.commands[0].command.height, -0.02);
  EXPECT_EQ(script.commands[0].gait, "");
  EXPECT_EQ(script.commands[1].gait, "stand");
  EXPECT_EQ(script.commands[1].command.forward, 0.0);
  ASSERT_EQ(script.pushes.size(), 1u);
  EXPECT_EQ(script.pushes[0].impulse, Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_EQ(script.pushes[0].time, 2.5);
  EXPECT_EQ(script.pushes[0].duration, 0.1);
}

TEST(ScriptFile, NamesTheMistake) {
  EXPECT_THAT(complaint("[[command]]\nvelocity_mps = [0.3, 0]\n"), HasSubstr("time_s"));
  EXPECT_THAT(complaint("[[command]]\ntime_s = -1\n"), HasSubstr("walk.toml:2:"));
  EXPECT_THAT(complaint("[[command]]\ntime_s = 1\ngait = \"hop\"\n"), HasSubstr("walk.toml:3:"));
  EXPECT_THAT(complaint("[[command]]\ntime_s = 1\nvelocity_mps = [0.3]\n"), HasSubstr("velocity_mps"));
  EXPECT_THAT(complaint("[[command]]\ntime_s = 1\nvelocity = [0.3, 0]\n"), HasSubstr("velocity_mps"));
  EXPECT_THAT(complaint("[[push]]\ntime_s = 1\nimpulse_Ns = [1, nan, 0]\n"), HasSubstr("impulse_Ns"));
  EXPECT_THAT(complaint("[[push]]\ntime_s = 1\nimpulse_Ns = [1, 0, 0]\nduration_s = 0\n"), HasSubstr("duration_s"));
  EXPECT_THAT(complaint("[[phase]]\n"), HasSubstr("task file"));
}

TEST(RandomEvents, AreThoseOfTheSeed) {
  const RobotModel robot(test::hyq_description());
  OnlineOptions options;
  options.duration = 30.0;
  add_kicks(robot, 0.5, options);
  add_random_commands(0.4, options);
  ASSERT_EQ(options.simulation.pushes.size(), 14u) << "at 2, 4 ... 28 s";
  for (const Push& push : options.simulation.pushes) {
    EXPECT_NEAR(push.impulse.norm(), 0.5 * robot.mass(), 1e-9);
    EXPECT_EQ(push.impulse.z(), 0.0);
  }
  ASSERT_GT(options.commands.size(), 6u);
  for (std::size_t i = 0; i < options.commands.size(); ++i) {
    const TimedCommand& timed = options.commands[i];
    EXPECT_LE(std::abs(timed.command.forward), 0.4);
    if (i > 0) EXPECT_GE(timed.time, options.commands[i - 1].time + 1.0);
  }
  OnlineOptions other;
  other.duration = 30.0;
  other.simulation.seed = 2;
  add_kicks(robot, 0.5, other);
  EXPECT_NE(other.simulation.pushes[0].impulse, options.simulation.pushes[0].impulse);
}

}  // namespace
}  // namespace prowl
