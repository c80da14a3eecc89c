#pragma once

#include "prowl/io/task_file.hpp"

namespace prowl {

constexpr int kMostIntervals = 10000;  ///< of a motion; a typing mistake above that, and gigabytes of memory

/// Throws InputError for values that no task file and no command line may have; a plan's file and a program may say anything.
void check_overrides(const SourceText& task_file, const TaskOverrides& overrides);

}  // namespace prowl
