#pragma once

#include <optional>

#include "prowl/diagnosis/diagnosis_run.hpp"

namespace prowl {

/// First part of a diagnosis: looks for a plan of the unchanged task. Sets run.result.
class TaskAsItIs {
 public:
  explicit TaskAsItIs(DiagnosisRun& run) : run_(run) {}

  /// Motion on the task's own mesh, if the search mesh and all finer meshes of the task have one. Otherwise `searched`
  /// gets the coarsest mesh without a motion, where a search for changes costs least. Feet may drift on coarse meshes.
  std::optional<Trajectory> solve_all_meshes();
  /// Plans as prowl plan does, in a part of the remaining time.
  void plan(double part);
  /// For a task that plan() did not solve, but its own mesh was solved from the initial guess.
  void take_from_own_mesh(const Trajectory& motion);
  /// Resumes plan() if its time was up.
  void go_on();

 private:
  void take_outcome();

  DiagnosisRun& run_;
  Plan plan_;
};

}  // namespace prowl
