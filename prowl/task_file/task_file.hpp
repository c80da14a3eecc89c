#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "prowl/files/text_file.hpp"
#include "prowl/model/urdf/package_path.hpp"
#include "prowl/task_file/task.hpp"

namespace prowl {

/// Reads a task file (docs/task-file.md) and the robot file that it names. Throws InputError
/// "file:line:column: key: ..." for whatever is wrong in either.
Task read_task_file(const std::filesystem::path& path, const PackageSearch& search,
                    const TaskOverrides& overrides = {});

/// The same from a text at hand; what it names is relative to the folder of task_file.path, where no file needs to be.
Task read_task_text(const SourceText& task_file, const PackageSearch& search, const TaskOverrides& overrides = {});

/// The same from texts at hand: those that a plan keeps. `robot_file` stands for the file that the task names, and
/// `urdf` for the one that the robot names if that is not there.
Task parse_task(const SourceText& task_file, const SourceText& robot_file, const PackageSearch& search,
                const TaskOverrides& overrides = {}, const std::optional<SourceText>& urdf = std::nullopt);

/// "hyq_crouch" for tasks/hyq/crouch.toml: folder and name tell one task from another.
std::string task_slug(const std::filesystem::path& task_file);

}  // namespace prowl
