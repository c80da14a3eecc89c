#pragma once

#include "prowl/task_file/task.hpp"

namespace prowl {

/// Throws InputError for values that no task file and no command line may have; a plan's file and a program may say
/// anything.
void check_overrides(const SourceText& task_file, const TaskOverrides& overrides);

}  // namespace prowl
