#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "prowl/session/plan_record.hpp"

namespace prowl::cli {

// Output of --json (docs/command-line.md): one object on stdout and nothing else, also for errors.

/// {"verb", "exit_status", "written": [paths], and all members of `result`}; with a plan also
/// "directory", "name" and "robot".
struct JsonResult {
  std::string verb;
  int exit_status = 0;
  const PlanRecord* plan = nullptr;                 ///< subject of the result
  std::filesystem::path directory = {};             ///< of that plan
  std::vector<std::filesystem::path> written = {};  ///< files, as the user may name them
  std::string result = "{}";                        ///< text of a JSON object
};
/// Throws FileError if writing fails.
void print_json(const JsonResult& result);

/// {"verb", "exit_status", "error": {"kind", "message"; "file", "line", "column" if the message
/// begins with them}}. On a closed stdout the message is lost, but not the exit status.
void print_json_error(const std::string& verb, int exit_status, const std::string& message) noexcept;

/// True if --json is among the arguments, even if they do not parse.
bool asks_for_json(int argc, const char* const* argv);

}  // namespace prowl::cli
