#include "prowl/batch/key_path.hpp"

#include <gmock/gmock.h>

#include <limits>
#include <random>

#include "prowl/error.hpp"

namespace prowl {
namespace {

const char* const kTask = R"(
name = "x"
[[goal]]
time_s = 1.0
base_displacement_m = [0, 0, -0.1]
[[goal]]
time_s = 2.0
)";

/// The task with one value changed.
toml::table changed(const std::string& path, const std::string& value) {
  toml::table task = toml::parse(kTask);
  set_at(task, path, value);
  return toml::parse(toml_text(task));
}

TEST(KeyPath, SetsEntriesOfListsAndKeysOfTables) {
  EXPECT_EQ(changed("goal[0].base_displacement_m[2]", "-0.25")["goal"][0]["base_displacement_m"][2].value<double>(),
            -0.25);
  EXPECT_EQ(changed("goal[1].time_s", "1.5")["goal"][1]["time_s"].value<double>(), 1.5);
  EXPECT_EQ(changed("goal[1].base_rpy_rad", "[0, 0, 0.5]")["goal"][1]["base_rpy_rad"][2].value<double>(), 0.5);
  EXPECT_EQ(changed("name", "\"y\"")["name"].value<std::string>(), "y");
  EXPECT_EQ(changed("goal[0].time_s", "1.5")["goal"][1]["time_s"].value<double>(), 2.0) << "all else stays";
}

TEST(KeyPath, SaysWhatIsMissing) {
  const auto said = [](const std::string& path) -> std::string {
    try {
      changed(path, "1");
      return "";
    } catch (const InputError& error) {
      return error.what();
    }
  };
  EXPECT_EQ(said("goal[2].time_s"), "the task has no goal[2]");
  EXPECT_EQ(said("gait.speed"), "the task has no gait");
  EXPECT_EQ(said("goal[0].base_displacement_m[3]"), "the task has no goal[0].base_displacement_m[3]");
  EXPECT_EQ(said("name.x"), "the task's name has no keys");
  for (const char* const path : {"", ".", "goal[", "goal[]", "goal[x]", "goal[00].time_s", "goal[0]time_s",
                                 "goal[99999999]", "a..b", "[", "a."}) {
    EXPECT_THAT(said(path), testing::HasSubstr("is no path of keys")) << path;
  }
}

TEST(KeyPath, NumbersReadBackAsTheSame) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> exponent(-30.0, 30.0);
  for (int i = 0; i < 1000; ++i) {
    const double number = std::pow(10.0, exponent(random)) * (i % 2 ? 1.0 : -1.0);
    EXPECT_EQ(parsed_value(toml_number(number))["value"].value<double>(), number);
    toml::table task = toml::parse("x = 0");
    set_at(task, "x", toml_number(number));
    EXPECT_EQ(toml::parse(toml_text(task))["x"].value<double>(), number) << "through the text of a document";
  }
  EXPECT_EQ(parsed_value(toml_number(3.0))["value"].type(), toml::node_type::floating_point);
}

}  // namespace
}  // namespace prowl
