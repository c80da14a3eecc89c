#pragma once

#include <string>
#include <vector>

#include "cli/process/exit_status.hpp"

namespace prowl::cli {

/// State of one requirement of Prowl on this machine.
struct Finding {
  enum class State { ok, slow, missing, foreign };
  std::string area;  ///< "build", "machine", "solvers", "files"
  std::string name;  ///< "Riccati"
  State state = State::ok;
  std::string text;    ///< finding or problem
  std::string remedy;  ///< action for the user; "" if none
  /// Exit status that it causes; kPassed if only some verbs need it.
  ExitStatus status = kPassed;
};

std::vector<Finding> check_build();
std::vector<Finding> check_machine();
/// Solves a small built-in task with each solver: a quadruped that stands still for half a second.
/// Needs no files.
std::vector<Finding> check_solvers();
std::vector<Finding> check_files();

}  // namespace prowl::cli
