#pragma once

#include "prowl/diagnosis/diagnosis_run.hpp"

namespace prowl {

/// The second part of a diagnosis, of a task without a plan: the smallest changes that make it solvable on the mesh of
/// the search, where limits of that kind give way, and the first change that holds on the task's own mesh. What is
/// found is in the run's result.
void look_for_changes(DiagnosisRun& run);

}  // namespace prowl
