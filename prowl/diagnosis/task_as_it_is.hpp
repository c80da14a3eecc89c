#pragma once

#include <optional>

#include "prowl/diagnosis/diagnosis_run.hpp"

namespace prowl {

/// The first part of a diagnosis: whether the task has a plan as it is. What is found is in the run's result.
class TaskAsItIs {
 public:
  explicit TaskAsItIs(DiagnosisRun& run) : run_(run) {}

  /// The motion on the task's own mesh, if there is one on the search mesh, on all finer ones of the task and on that.
  /// Else `searched` is on the coarsest without: there it costs least to look for changes. Feet may drift on coarse
  /// ones: a finer one will tell.
  std::optional<Trajectory> solve_all_meshes();
  /// As prowl plan does, in a part of the time that is left.
  void plan(double part);
  /// plan() did not get there, but the task's own mesh was solved from the initial guess.
  void take_from_own_mesh(const Trajectory& motion);
  /// From where the time was up for plan().
  void go_on();

 private:
  void judge();

  DiagnosisRun& run_;
  Plan plan_;
};

}  // namespace prowl
