#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "prowl/io/task_file.hpp"
#include "prowl/plan.hpp"
#include "prowl/tracking/feedback_design.hpp"

namespace prowl {

/// One iteration of the solver, and on which mesh: 0 is the first, the coarsest.
struct MeshIteration {
  int level = 0;
  SolveProgress progress;
};

/// A plan, what it was made from, and by what.
struct PlanRecord {
  Task task;
  Plan plan;                                    ///< of the result, z and multipliers are not kept in files
  std::map<std::string, std::string> versions;  ///< "prowl" -> "0.1.0", "Ipopt" -> ...
  std::optional<FeedbackDesign> feedback = {};  ///< gains, if there are; not read back: Tracker::read does
  std::vector<MeshIteration> iterations = {};   ///< of all meshes, in order; empty if nobody wrote them down
  std::string warm_start = {};                  ///< folder of the plan that it started from; "" if from the task alone
};

/// Whether the plan may be used: the solver converged and the certificate passed.
bool is_good(const Plan& plan);

/// Whether the folder holds a plan that is good, by its own plan.json: one that a new plan would replace.
bool holds_good_plan(const std::filesystem::path& directory);

/// Throws FileError if write_plan could not replace this folder; for a look before solving.
void check_plan_directory(const std::filesystem::path& directory);

/// Writes plan.json and trajectory.csv (docs/plan-directory.md), tracker.bin if there are gains, and
/// trajectory_uniform.csv if a step [s] is given; whole or not at all, see write_folder_atomically. Throws FileError.
void write_plan(const std::filesystem::path& directory, const PlanRecord& record,
                std::optional<double> uniform_step = std::nullopt);

/// Reads what write_plan wrote, but tracker.bin and trajectory_uniform.csv; the task comes from the texts in plan.json,
/// and the URDF, too, if it is no longer where it was. Throws InputError naming file and key for anything missing,
/// wrong or changed since, FileError.
PlanRecord read_plan(const std::filesystem::path& directory, const PackageSearch& search);

/// plan.json but for the texts of task, robot and URDF: what `prowl plan --json` prints. With "directory" unless
/// that is empty.
std::string plan_report_json(const PlanRecord& record, const std::filesystem::path& directory);

}  // namespace prowl
