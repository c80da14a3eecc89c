#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "prowl/plan_folder/plan_folder.hpp"

namespace prowl {

/// Keeps the best iterate of a solve on disk while it goes on: least violation of the constraints, and among those
/// within tolerance least cost, on the mesh that is being solved. It is the folder of a plan (write_plan) with status
/// `interrupted` and an empty certificate, so that whatever reads plans reads it. It is replaced whole or not at all.
///
/// A kill loses the iterates of the last `every` seconds, and of the iteration and the writing that were going on.
class Checkpoint {
 public:
  /// `so_far`: task, versions and warm_start of the plan. Throws FileError as check_plan_directory().
  Checkpoint(std::filesystem::path folder, double every, PlanRecord so_far);

  /// Adds itself to PlanOptions::on_iterate, after what is there; it has to outlive the solve. Nothing is thrown during
  /// that: why something could not be written goes to `on_failure`, and the next attempt is made `every` seconds later.
  void watch(std::function<void(Plan)>& on_iterate, std::function<void(const std::string& why)> on_failure);

 private:
  void take(Plan iterate);
  void write();

  std::filesystem::path folder_;
  double every_;  ///< [s]
  PlanRecord best_;
  bool is_written_ = true;
  double next_;  ///< in wall_seconds()
  std::function<void(const std::string&)> on_failure_;
};

/// Throws InputError unless a solve of `task` on `meshes` can go on from that plan, which was not finished: the same
/// texts of task, robot and URDF, and one of these meshes. No meshes: any will do.
void check_resumable(const PlanRecord& record, const Task& task, const std::vector<Mesh>& meshes);

}  // namespace prowl
