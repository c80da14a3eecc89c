#pragma once

#include "prowl/diagnosis/diagnosis_run.hpp"

namespace prowl {

/// Second part of a diagnosis, for a task without a plan. Finds the smallest changes that make it solvable on the
/// search mesh, the limits of that kind that give way, and the first change that holds on the task's own mesh. Sets
/// run.result.
void look_for_changes(DiagnosisRun& run);

}  // namespace prowl
