#pragma once

#include "prowl/diagnosis/diagnosis.hpp"
#include "prowl/task_file/task.hpp"

namespace prowl {

/// Why a task has no plan, with the solvers of plan_task(): the one way that all front ends take. Tolerance and limits
/// of the solver are the task's; of options.solver, interrupt and on_iteration are kept. Throws InputError unless
/// options.max_seconds > 0.
Diagnosis diagnose_task(const Task& task, DiagnosisOptions options);

}  // namespace prowl
