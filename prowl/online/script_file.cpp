#include "prowl/online/script_file.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "prowl/mpc/stepping_patterns.hpp"
#include "prowl/task_file/toml/toml_value.hpp"

namespace prowl {
namespace {

FileKeys make_script_file_keys() {
  const NumberRange speed{.lower = -kFastestCommand, .upper = kFastestCommand}, time = NumberRange::nonnegative();
  const char* const kMoment = "time from the start of the run";
  return {
      {.name = "command", .form = "[[command]]", .meaning = "what the robot is told from a time on"},
      {.name = "push", .form = "[[push]]", .meaning = "a force on the base"},
      {.table = "command", .name = "time_s", .form = "number", .range = time, .unit = "s", .meaning = kMoment},
      {.table = "command",
       .name = "velocity_mps",
       .form = "[number, number]",
       .range = speed,
       .unit = "m/s",
       .fallback = "[0, 0]",
       .meaning = "ahead and to the left"},
      {.table = "command",
       .name = "turn_radps",
       .form = "number",
       .range = speed,
       .unit = "rad/s",
       .fallback = "0",
       .meaning = "turn rate about the vertical"},
      {.table = "command",
       .name = "height_m",
       .form = "number",
       .unit = "m",
       .fallback = "0",
       .meaning = "of the base, from its standing height"},
      {.table = "command",
       .name = "gait",
       .choices = stepping_gaits(),
       .fallback = "as before",
       .meaning = "how the robot steps"},
      {.table = "push", .name = "time_s", .form = "number", .range = time, .unit = "s", .meaning = kMoment},
      {.table = "push",
       .name = "impulse_Ns",
       .form = "[number, number, number]",
       .unit = "N s",
       .meaning = "in the world"},
      {.table = "push",
       .name = "duration_s",
       .form = "number",
       .range = NumberRange::positive(),
       .unit = "s",
       .fallback = fmt::format("{:g}", Push{}.duration),
       .meaning = "the force is constant over it"},
  };
}

TimedCommand read_command(const TomlTable& table) {
  TimedCommand timed{.time = table.need("time_s").as_number(), .command = {}};
  if (const auto velocity = table.find("velocity_mps")) {
    const std::vector<TomlValue> parts = velocity->as_list(2);
    timed.command.forward = parts[0].as_number();
    timed.command.left = parts[1].as_number();
  }
  if (const auto turn = table.find("turn_radps")) timed.command.turn = turn->as_number();
  if (const auto height = table.find("height_m")) timed.command.height = height->as_number();
  if (const auto gait = table.find("gait")) timed.gait = gait->as_choice("gait");
  return timed;
}

Push read_push(const TomlTable& table) {
  Push push{table.need("impulse_Ns").as_vector3(), table.need("time_s").as_number()};
  if (const auto duration = table.find("duration_s")) push.duration = duration->as_number();
  return push;
}

}  // namespace

const FileKeys& script_file_keys() {
  static const FileKeys keys = make_script_file_keys();
  return keys;
}

Script read_script(const SourceText& source) {
  const TomlDocument document(source);
  document.refuse_key("phase", "this looks like a task file; need a script, with [[command]] and [[push]]");
  document.check_all_keys(script_file_keys());
  return document.read_with([&] {
    const TomlTable root = document.root(script_file_keys());
    Script script;
    for (const TomlTable& table : root.find_tables("command")) script.commands.push_back(read_command(table));
    for (const TomlTable& table : root.find_tables("push")) script.pushes.push_back(read_push(table));
    std::ranges::stable_sort(script.commands, {}, &TimedCommand::time);
    return script;
  });
}

void add_script(const Script& script, OnlineOptions& options) {
  std::vector<Push>& pushes = options.simulation.pushes;
  options.commands.insert(options.commands.end(), script.commands.begin(), script.commands.end());
  pushes.insert(pushes.end(), script.pushes.begin(), script.pushes.end());
}

}  // namespace prowl
