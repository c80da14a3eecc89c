#pragma once

#include <optional>

#include "prowl/simulation/simulation_options.hpp"
#include "prowl/task_file/toml/toml_value.hpp"

namespace prowl {

/// Simulation settings of a task.
struct TaskSimulation {
  SuccessCriteria success;
  std::optional<double> friction;  ///< of all surfaces, never above theirs; nullopt: as planned
};

/// Reads [simulation] of a task file; missing keys keep their defaults, and so do keys that ask for less.
TaskSimulation read_simulation(const TomlTable& root);

}  // namespace prowl
