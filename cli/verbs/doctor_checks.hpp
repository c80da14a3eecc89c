#pragma once

#include <string>
#include <vector>

#include "cli/process/exit_status.hpp"

namespace prowl::cli {

/// One thing that Prowl needs or can use, as it is on this machine.
struct Finding {
  enum class State { ok, slow, missing };
  std::string area;  ///< "build", "machine", "solvers", "files"
  std::string name;  ///< "Riccati"
  State state = State::ok;
  std::string text;    ///< what was found, or what is the matter
  std::string remedy;  ///< what to do about it; "" if nothing
  /// What it makes the command end with: kPassed for what only some verbs use.
  ExitStatus status = kPassed;
};

std::vector<Finding> check_build();
std::vector<Finding> check_machine();
/// Each solver plans a robot of four legs that stands still for half a second: written here, so that it needs no files.
std::vector<Finding> check_solvers();
std::vector<Finding> check_files();

}  // namespace prowl::cli
