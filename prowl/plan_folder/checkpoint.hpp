#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "prowl/plan_folder/plan_folder.hpp"

namespace prowl {

/// Keeps the best iterate of a running solve on disk: least violation of the constraints or, within the tolerance,
/// least cost, on the current mesh. It is the folder of a plan (write_plan) with status `interrupted` and an empty
/// certificate, readable like any plan, and replaced whole or not at all.
///
/// A kill loses the iterates of the last `every` seconds and of the current iteration and write.
class Checkpoint {
 public:
  /// `so_far`: task, versions and warm_start of the plan. Throws FileError as check_plan_directory().
  Checkpoint(std::filesystem::path folder, double every, PlanRecord so_far);

  /// Appends itself to PlanOptions::on_iterate; it must outlive the solve. Throws nothing during the solve: reports
  /// failed writes to `on_failure` and tries again after `every` seconds.
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

/// Throws InputError unless a solve of `task` on `meshes` can resume that unfinished plan: same texts of task, robot
/// and URDF, and one of these meshes (any if there are none).
void check_resumable(const PlanRecord& record, const Task& task, const std::vector<Mesh>& meshes);

}  // namespace prowl
