// Over all keys that the readers declare: a mistake in one is reported at its line and column, with what was meant.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <map>
#include <sstream>

#include "prowl/task_file/robot_file.hpp"
#include "prowl/task_file/task_file.hpp"
#include "prowl/task_file/toml/file_keys.hpp"
#include "tests/support/reference_csv.hpp"
#include "tests/support/test_files.hpp"

namespace prowl {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

using Lines = std::vector<std::string>;

/// A file around one table: its header and lines that are right, so that nothing else can be complained of.
struct Context {
  std::string before;
  Lines lines;
  std::string after;
};

const std::string kStanding = "[[phase]]\nname = \"stand\"\ncontacts = \"all\"\nduration_s = 2\nintervals = 5\n";

/// By table, as in FileKey. Goals that bind nothing, gaits without strides and the like are mistakes of their own.
const std::map<std::string, Context>& task_contexts() {
  static const std::string robot = "robot = \"hyq.toml\"\n";
  static const std::string task = robot + kStanding;
  static const std::map<std::string, Context> contexts = {
      {"", {"", {"robot = \"hyq.toml\"", "phase = [{ contacts = \"all\", duration_s = 2, intervals = 5 }]"}, ""}},
      {"surface", {task + "[[surface]]\n", {"name = \"floor\""}, ""}},
      {"payload", {task + "[[payload]]\n", {"body = \"trunk\"", "mass_kg = 5"}, ""}},
      {"start", {task + "[start]\n", {}, ""}},
      {"phase", {robot + "[[phase]]\n", {"contacts = \"all\"", "duration_s = 2", "intervals = 5"}, ""}},
      {"phase.contacts",
       {robot + "[[phase]]\nduration_s = 2\nintervals = 5\n[[phase.contacts]]\n", {"contact = \"lf_foot\""}, ""}},
      {"gait", {robot + "[gait]\n", {"kind = \"trot\"", "strides = 1", "stride_s = 2", "stride_length_m = 0.1"}, ""}},
      {"goal", {task + "[[goal]]\n", {"phase = \"stand\"", "torque_Nm = { lf_haa_joint = 1 }"}, ""}},
      {"term", {task + "[[term]]\n", {"phase = \"stand\"", "com_m = [0, 0, 0]", "weight = 1"}, ""}},
      {"reference", {task + "[reference]\n", {"file = \"motion.csv\"", "joint_position = 1"}, ""}},
      {"reference.frame",
       {task + "[reference]\nfile = \"motion.csv\"\n[[reference.frame]]\n", {"frame = \"lf_foot\"", "weight = 1"}, ""}},
      {"cost", {task + "[cost]\n", {}, ""}},
      {"cost.contact_position",
       {task + "[[cost.contact_position]]\n", {"contact = \"lf_foot\"", "reference_m = [0, 0, 0]", "weight = 1"}, ""}},
      {"terminal_cost", {task + "[terminal_cost]\n", {}, ""}},
      {"terminal_cost.contact_position",
       {task + "[[terminal_cost.contact_position]]\n",
        {"contact = \"lf_foot\"", "reference_m = [0, 0, 0]", "weight = 1"},
        ""}},
      {"solver", {task + "[solver]\n", {}, ""}},
      {"tracking", {task + "[tracking]\n", {}, ""}},
      {"robust", {task + "[robust]\n", {}, ""}},
      {"simulation", {task + "[simulation]\n", {}, ""}},
  };
  return contexts;
}

const std::map<std::string, Context>& robot_contexts() {
  static const std::string name = test::kHyqFile.substr(0, test::kHyqFile.find("contact = ["));
  static const std::string rest = test::kHyqFile.substr(test::kHyqFile.find("[nominal.joints]"));
  static const std::map<std::string, Context> contexts = {
      {"",
       {"",
        {"name = \"HyQ\"", name.substr(name.find("urdf")), "contact = [{ name = \"a\", frame = \"lf_foot\" }]"},
        ""}},
      {"contact", {name + "[[contact]]\n", {"name = \"lf_foot\"", "frame = \"lf_foot\""}, rest}},
      {"nominal", {name + "contact = [{ name = \"a\", frame = \"lf_foot\" }]\n[nominal]\n", {}, ""}},
      {"limits", {test::kHyqFile + "[limits.lf_haa_joint]\n", {}, ""}},
  };
  return contexts;
}

struct File {
  std::string text;
  int line;  ///< of the mistake, from 1
};

/// The context with `mistake` as its last line, in place of the line of `key` if there is one.
File with_mistake(const Context& context, const std::string& key, const std::string& mistake) {
  std::string text = context.before;
  for (const std::string& line : context.lines) {
    if (!line.starts_with(key + " =")) text += line + (line.ends_with('\n') ? "" : "\n");
  }
  const auto line = static_cast<int>(std::count(text.begin(), text.end(), '\n')) + 1;
  return {text + mistake + "\n" + context.after, line};
}

/// One letter changed, missing, doubled or two swapped, at `position`.
Lines misspellings(const std::string& name, std::size_t position) {
  Lines wrong;
  std::string other = name;
  other[position] = 'x';
  wrong.push_back(other);
  if (name.size() > 2) wrong.push_back(name.substr(0, position) + name.substr(position + 1));
  wrong.push_back(name.substr(0, position) + name[position] + name.substr(position));
  other = name;
  const std::size_t first = std::min(position, name.size() - 2);
  std::swap(other[first], other[first + 1]);
  if (other != name) wrong.push_back(other);
  return wrong;
}

std::string letters(std::string name) {
  std::erase(name, '_');
  return name;
}

bool is_one_letter_off(const std::string& name, const std::string& wrong) {
  if (name.size() != wrong.size()) return false;
  int off = 0;
  for (std::size_t i = 0; i < name.size(); ++i) off += name[i] != wrong[i];
  return off == 1;
}

class FileMistakes : public testing::Test {
 protected:
  std::string robot_message(const std::string& text) const {
    const auto file = folder_.write("robot.toml", text);
    return test::message_of(folder_.path(), [&] { load_robot(read_text_file(file), test::test_search()); });
  }
  std::string task_message(const std::string& text) const {
    folder_.write("hyq.toml", test::kHyqFile);
    folder_.write("motion.csv", test::reference_csv({0.0, 1.0}));
    const auto file = folder_.write("task.toml", text);
    return test::message_of(folder_.path(), [&] { read_task_file(file, test::test_search()); });
  }

  template <typename Message>
  void check_misspellings(const std::string& file, const FileKeys& keys, const std::map<std::string, Context>& contexts,
                          const Message& message) const {
    int checked = 0;
    for (std::size_t k = 0; k < keys.size(); ++k) {
      const FileKey& key = keys[k];
      const Lines names = key_names(keys, key.table);
      for (const std::string& wrong : misspellings(key.name, key.name.size() / 2)) {
        if (std::find(names.begin(), names.end(), wrong) != names.end()) continue;
        const File broken = with_mistake(contexts.at(key.table), key.name, "  " + wrong + " = 1");
        std::vector<testing::Matcher<std::string>>
            suggestions;  // strides and stride_s are both one letter from stride_, robot and robust from robst
        for (const std::string& name : names) {
          if (letters(name) == letters(key.name) || is_one_letter_off(name, wrong))
            suggestions.push_back(HasSubstr(wrong + ": unknown key; did you mean '" + name + "'?"));
        }
        EXPECT_THAT(message(broken.text),
                    AllOf(StartsWith(fmt::format("{}:{}:3: ", file, broken.line)), testing::AnyOfArray(suggestions)));
        ++checked;
      }
    }
    EXPECT_GT(checked, 3 * static_cast<int>(keys.size()));
  }

  /// A date is what no key takes.
  template <typename Message>
  void check_types(const std::string& file, const FileKeys& keys, const std::map<std::string, Context>& contexts,
                   const Message& message) const {
    for (const FileKey& key : keys) {
      const std::string replaced = key.name == "time_s" ? "phase" : key.name;  // either of the two in a goal
      const File broken = with_mistake(contexts.at(key.table), replaced, key.name + "  = 1979-05-27");
      const std::string text = message(broken.text);
      EXPECT_THAT(text, AllOf(StartsWith(fmt::format("{}:{}:{}: ", file, broken.line, key.name.size() + 5)),
                              HasSubstr(key.name + ": "), HasSubstr("need ")))
          << key.table << "." << key.name;
    }
  }

  /// A number right outside the declared range, in the form of the key; "" where any number is allowed.
  static std::string outside(const FileKey& key) {
    const NumberRange& range = key.range;
    if (range.limits().empty()) return "";
    const double beyond = range.above_lower ? range.lower : range.lower - std::max(1e-6, 1e-6 * std::abs(range.lower));
    const std::string number = fmt::format("{}", key.form == "integer" ? range.lower - 1.0 : beyond);
    return key.form.starts_with("3 ") ? fmt::format("[{}, 0, 0]", number) : number;
  }

  template <typename Message>
  void check_ranges(const std::string& file, const FileKeys& keys, const std::map<std::string, Context>& contexts,
                    const Message& message) const {
    int checked = 0;
    for (const FileKey& key : keys) {
      const std::string value = outside(key);
      if (value.empty()) continue;
      const std::string replaced = key.name == "time_s" ? "phase" : key.name;
      const File broken = with_mistake(contexts.at(key.table), replaced, key.name + " = " + value);
      EXPECT_THAT(message(broken.text), AllOf(StartsWith(fmt::format("{}:{}:", file, broken.line)),
                                              HasSubstr("is not allowed; need "), HasSubstr(key.range.limits())))
          << key.table << "." << key.name;
      ++checked;
    }
    EXPECT_GT(checked, 2);
  }

  test::TempFolder folder_;
};

TEST_F(FileMistakes, ContextsAreRight) {
  for (const auto& [table, context] : task_contexts())
    EXPECT_EQ(task_message(with_mistake(context, "?", "").text), "") << table;
  for (const auto& [table, context] : robot_contexts())
    EXPECT_EQ(robot_message(with_mistake(context, "?", "").text), "") << table;
}

TEST_F(FileMistakes, MisspeltKeysOfARobot) {
  check_misspellings("robot.toml", robot_file_keys(), robot_contexts(),
                     [this](const auto& text) { return robot_message(text); });
}

TEST_F(FileMistakes, MisspeltKeysOfATask) {
  check_misspellings("task.toml", task_file_keys(), task_contexts(),
                     [this](const auto& text) { return task_message(text); });
}

TEST_F(FileMistakes, WrongTypesInARobot) {
  check_types("robot.toml", robot_file_keys(), robot_contexts(),
              [this](const auto& text) { return robot_message(text); });
}

TEST_F(FileMistakes, WrongTypesInATask) {
  check_types("task.toml", task_file_keys(), task_contexts(), [this](const auto& text) { return task_message(text); });
}

TEST_F(FileMistakes, DeclaredRangesAreKept) {
  check_ranges("robot.toml", robot_file_keys(), robot_contexts(),
               [this](const auto& text) { return robot_message(text); });
  check_ranges("task.toml", task_file_keys(), task_contexts(), [this](const auto& text) { return task_message(text); });
}

// One run tells all of them, from the top of the file to its end.
TEST_F(FileMistakes, SeveralAreToldAtOnce) {
  const std::string text =
      "robot = \"hyq.toml\"\n[[phase]]\nname = \"stand\"\ncontacts = \"all\"\nduration = 2\nintervals = \"five\"\n"
      "[[goal]]\ntime_s = \"late\"\nbase_displacment_m = [0, 0, 0.1]\n[solver]\ntolerance = 5\n";
  const std::string message = task_message(text);
  std::istringstream lines(message);
  std::vector<std::string> all;
  for (std::string line; std::getline(lines, line);) all.push_back(line);
  EXPECT_THAT(all, testing::ElementsAre(StartsWith("task.toml:5:1: phase[0].duration: unknown key"),
                                        StartsWith("task.toml:6:13: phase[0].intervals: \"five\" is not allowed"),
                                        StartsWith("task.toml:8:10: goal[0].time_s: \"late\" is not allowed"),
                                        StartsWith("task.toml:9:1: goal[0].base_displacment_m: unknown key"),
                                        StartsWith("task.toml:11:13: solver.tolerance: 5 is not allowed")))
      << message;
}

TEST_F(FileMistakes, SeveralOfARobotAreToldAtOnce) {
  const std::string message = robot_message(test::kHyqFile +
                                            "[limits.lf_haa_joint]\ntorque_nm = 3\nvelocity_radps = -1\n"
                                            "[limits.rf_haa_joint]\nposition_rad = 2\n");
  EXPECT_THAT(message, AllOf(HasSubstr("torque_nm: unknown key; did you mean 'torque_Nm'?"),
                             HasSubstr("\nrobot.toml:24:18: limits.lf_haa_joint.velocity_radps: -1 is not allowed"),
                             HasSubstr("\nrobot.toml:26:16: limits.rf_haa_joint.position_rad: 2 is not allowed")));
}

TEST_F(FileMistakes, OfTheRobotComesAfterThoseOfTheTask) {
  folder_.write("broken.toml", test::kHyqFile + "[limits.lf_haa_joint]\ntorque_Nm = -3\n");
  const std::string message = task_message("robot = \"broken.toml\"\nnaem = \"x\"\n" + kStanding);
  EXPECT_THAT(message, AllOf(StartsWith("task.toml:2:1: naem: unknown key"),
                             HasSubstr("\nbroken.toml:23:13: limits.lf_haa_joint.torque_Nm: -3 is not allowed")));
}

// What follows from a value that was put in place of a wrong one is no mistake of the user.
TEST_F(FileMistakes, WhatFollowsFromAMistakeIsNotTold) {
  const std::string late = test::replaced(kStanding, "duration_s = 2", "duration_s = \"two\"");
  EXPECT_THAT(task_message("robot = \"hyq.toml\"\n" + late + "[[goal]]\ntime_s = 2\nbase_displacement_m = [0, 0, 0]\n"),
              AllOf(StartsWith("task.toml:5:14: phase[0].duration_s: \"two\""), testing::Not(HasSubstr("\n"))));
  std::string many = "robot = \"hyq.toml\"\n" + kStanding;
  for (int i = 0; i < 15; ++i) many += fmt::format("wrong_{} = 1\n", i);
  EXPECT_THAT(task_message(many), AllOf(HasSubstr("wrong_9"), testing::EndsWith("\nand 5 more")));
}

TEST_F(FileMistakes, MisspeltTables) {
  EXPECT_THAT(task_message("robot = \"hyq.toml\"\n" + kStanding + "[csot]\n"),
              StartsWith("task.toml:7:2: csot: unknown key; did you mean 'cost'? Known: "));
  EXPECT_THAT(task_message("robot = \"hyq.toml\"\n" + kStanding + "[[goals]]\ntime_s = 1\n"),
              StartsWith("task.toml:7:3: goals: unknown key; did you mean 'goal'? Known: "));
  EXPECT_THAT(robot_message(test::kHyqFile + "[limit.lf_haa_joint]\n"),
              AllOf(HasSubstr(":2: limit: "), HasSubstr("'limits'?")));
}

TEST_F(FileMistakes, KeysOfAnotherTableAreSentThere) {
  EXPECT_THAT(task_message("robot = \"hyq.toml\"\n" + kStanding + "[cost]\nduration_s = 3\n"),
              HasSubstr("It is a key of [phase]. Known: "));
  EXPECT_THAT(task_message("robot = \"hyq.toml\"\n" + kStanding + "swing_clearance_m = 3\n"),
              HasSubstr("It is a key of the top of the file. Known: "));
}

TEST_F(FileMistakes, MisspeltNames) {
  const auto robot = [this](const std::string& from, const std::string& to) {
    return robot_message(test::replaced(test::kHyqFile, from, to));
  };
  EXPECT_THAT(robot("frame = \"lf_foot\"", "frame = \"lf_fot\""),
              AllOf(StartsWith("robot.toml:4:31: contact[0].frame: "), HasSubstr("did you mean 'lf_foot'?")));
  EXPECT_THAT(
      robot("lf_haa_joint = ", " lf_haa_jont = "),
      AllOf(StartsWith("robot.toml:10:2: nominal.joints.lf_haa_jont: "), HasSubstr("did you mean 'lf_haa_joint'?")));
  EXPECT_THAT(robot_message(test::kHyqFile + "[limits.lf_ha_joint]\ntorque_Nm = 3\n"),
              AllOf(StartsWith("robot.toml:22:9: limits.lf_ha_joint: "), HasSubstr("did you mean 'lf_haa_joint'?")));
  const std::string gait =
      "robot = \"hyq.toml\"\n[gait]\nkind = \"wlak\"\nstrides = 1\nstride_s = 2\nstride_length_m = 0.1\n";
  EXPECT_THAT(task_message(gait), StartsWith("task.toml:3:8: gait.kind: unknown gait \"wlak\"; did you mean 'walk'?"));
}

TEST_F(FileMistakes, SyntaxErrors) {
  const std::string start = "robot = \"hyq.toml\"\n" + kStanding;
  for (const auto& [line, column] : std::vector<std::pair<std::string, int>>{{"[cost", 6},
                                                                             {"[cost]]", 7},
                                                                             {"x = \"abc", 9},
                                                                             {"x = [1, 2", 10},
                                                                             {"x 3", 3},
                                                                             {"x = 1 2", 7},
                                                                             {"= 3", 1},
                                                                             {"x = 1.", 7}}) {
    const std::string message = task_message(start + line + "\n[solver]\n");
    EXPECT_THAT(message, testing::MatchesRegex("task.toml:[78]:[0-9]+: .*")) << line;
    EXPECT_THAT(message, testing::AnyOf(HasSubstr(fmt::format(":7:{}: ", column)), HasSubstr(":8:"))) << line;
  }
  EXPECT_THAT(task_message("<robot/>"), StartsWith("task.toml:1:1: "));
}

}  // namespace
}  // namespace prowl
