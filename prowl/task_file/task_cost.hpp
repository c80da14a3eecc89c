#pragma once

// Reads [cost] and [terminal_cost] of a task file. Not installed: exposes toml++.
#include "prowl/motion/motion_problem.hpp"
#include "prowl/task_file/toml/toml_value.hpp"

namespace prowl {

/// Sets running_cost and terminal_cost; needs robot, phases and boundary constraints of `problem`.
void read_costs(const TomlTable& root, MotionProblem& problem);

}  // namespace prowl
