#pragma once

#include <optional>

#include "prowl/motion/disturbances.hpp"
#include "prowl/motion/motion_problem.hpp"
#include "prowl/task_file/toml/toml_value.hpp"

namespace prowl {

/// Table [robust]; `asked`: default sizes without it. Nullopt: neither.
std::optional<Disturbances> read_robust(const TomlTable& root, const MotionProblem& problem, bool asked);

}  // namespace prowl
