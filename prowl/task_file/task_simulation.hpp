#pragma once

#include <optional>

#include "prowl/simulation/simulation_options.hpp"
#include "prowl/task_file/toml/toml_value.hpp"

namespace prowl {

/// What a task says of its simulation.
struct TaskSimulation {
  SuccessCriteria success;
  std::optional<double> friction;  ///< of all surfaces; none: as planned
};

/// [simulation] of a task file; defaults where it says nothing.
TaskSimulation read_simulation(const TomlTable& root);

}  // namespace prowl
