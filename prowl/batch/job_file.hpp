#pragma once

#include <filesystem>
#include <functional>

#include "prowl/batch/job.hpp"
#include "prowl/task_file/task_file.hpp"
#include "prowl/task_file/toml/file_keys.hpp"

namespace prowl {

/// Keys of a job file, declared as those of tasks and robots.
const FileKeys& job_file_keys();

/// Reads a job file (docs/batch.md) and the task file that it names: relative to the job file, or a shipped one, which
/// is NAME.toml in `shipped_tasks`. Throws InputError "file:line:column: key: ..." for all mistakes.
Job read_job_text(const SourceText& job_file, const std::filesystem::path& shipped_tasks);

/// The same with the text of the task at hand, as a library keeps it.
Job job_with_task(const SourceText& job_file, const SourceText& task_file);

/// Throws InputError unless the task is right at both ends of every draw, and with every choice of it.
void check_draws(const Job& job, const std::function<void(const SourceText& task_file)>& read_task);

}  // namespace prowl
