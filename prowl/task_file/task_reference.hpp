#pragma once

// Reads [reference] of a task file. Not installed: exposes toml++.
#include <optional>

#include "prowl/files/text_file.hpp"
#include "prowl/motion/motion_problem.hpp"
#include "prowl/task_file/toml/toml_value.hpp"

namespace prowl {

/// Adds the reference and its costs to the problem, and returns its file; nullopt without the table. `folder`: that of
/// the task file. `stored`: in place of the file.
std::optional<SourceText> read_reference(const TomlTable& root, const std::filesystem::path& folder,
                                         const std::optional<SourceText>& stored, MotionProblem& problem);

}  // namespace prowl
