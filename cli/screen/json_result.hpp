#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "prowl/session/plan_record.hpp"

namespace prowl::cli {

// What --json prints (docs/command-line.md): one object on stdout and nothing else, for errors too.

/// {"verb", "exit_status", "written": [paths], and all that the object `result` holds}; of a plan "directory", "name"
/// and "robot" as well.
struct JsonResult {
  std::string verb;
  int exit_status = 0;
  const PlanRecord* plan = nullptr;                 ///< that it is about
  std::filesystem::path directory = {};             ///< of that plan
  std::vector<std::filesystem::path> written = {};  ///< files, as the user may name them
  std::string result = "{}";                        ///< text of a JSON object
};
/// Throws FileError if it does not get through.
void print_json(const JsonResult& result);

/// {"verb", "exit_status", "error": {"kind", "message"; "file", "line", "column" where the message begins with them}}.
/// Nothing more can be said of an error while saying it: one on a closed stdout is lost, its exit status is not.
void print_json_error(const std::string& verb, int exit_status, const std::string& message) noexcept;

/// Whether --json is among the arguments, also of a command line that does not parse.
bool asks_for_json(int argc, const char* const* argv);

}  // namespace prowl::cli
