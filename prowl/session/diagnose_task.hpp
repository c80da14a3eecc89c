#pragma once

#include "prowl/diagnosis/diagnosis.hpp"
#include "prowl/task_file/task.hpp"

namespace prowl {

/// Finds why a task has no plan, with the solvers of plan_task(). All front ends call it. Tolerance
/// and limits of the solver are the task's; only `interrupt` and `on_iteration` of options.solver
/// are used. Throws InputError unless options.max_seconds > 0.
Diagnosis diagnose_task(const Task& task, DiagnosisOptions options);

}  // namespace prowl
