#pragma once

#include "prowl/files/text_file.hpp"
#include "prowl/online/online_run.hpp"
#include "prowl/task_file/toml/file_keys.hpp"

namespace prowl {

/// Of a command [m/s, rad/s]: beyond it the number is a mistake.
inline constexpr double kFastestCommand = 100.0;

/// Keys of a script, declared as those of tasks and robots.
const FileKeys& script_file_keys();

/// What a robot is told during a run, and what pushes it.
struct Script {
  std::vector<TimedCommand> commands;  ///< in the order of time
  std::vector<Push> pushes;
};

/// Adds what a script asks for to options.
void add_script(const Script& script, OnlineOptions& options);

/// Reads a script (docs/mpc.md). Throws InputError "file:line:column: key: ..." for all mistakes.
Script read_script(const SourceText& source);

}  // namespace prowl
