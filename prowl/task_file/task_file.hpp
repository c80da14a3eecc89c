#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "prowl/files/text_file.hpp"
#include "prowl/model/urdf/package_path.hpp"
#include "prowl/task_file/own_terms.hpp"
#include "prowl/task_file/task.hpp"

namespace prowl {

/// Reads a task file (docs/task-file.md) and its robot file. Throws InputError "file:line:column:
/// key: ..." for errors in either, FileError for an unreadable file. `own_terms`: those that it may use.
Task read_task_file(const std::filesystem::path& path, const PackageSearch& search, const TaskOverrides& overrides = {},
                    const OwnTerms& own_terms = {});

/// The same from text; its paths are relative to the folder of task_file.path, which need not
/// exist.
Task read_task_text(const SourceText& task_file, const PackageSearch& search, const TaskOverrides& overrides = {},
                    const OwnTerms& own_terms = {});

/// Copies of files that a task needs.
struct StoredFiles {
  std::optional<SourceText> urdf = {};       ///< used if the URDF file does not exist
  std::optional<SourceText> reference = {};  ///< used in place of the file of [reference]
};

/// The same from the texts stored in a plan. `robot_file` replaces the robot file of the task.
Task parse_task(const SourceText& task_file, const SourceText& robot_file, const PackageSearch& search,
                const TaskOverrides& overrides = {}, const StoredFiles& stored = {}, const OwnTerms& own_terms = {});

/// "hyq_crouch" for tasks/hyq/crouch.toml: folder and name.
std::string task_slug(const std::filesystem::path& task_file);

}  // namespace prowl
