#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "prowl/io/task_file.hpp"
#include "prowl/plan.hpp"

namespace prowl {

/// A plan, what it was made from, and by what.
struct PlanRecord {
  Task task;
  Plan plan;                                    ///< of the result, z and multipliers are not kept in files
  std::map<std::string, std::string> versions;  ///< "prowl" -> "0.1.0", "Ipopt" -> ...
};

/// Throws FileError if write_plan could not replace this folder; for a look before solving.
void check_plan_directory(const std::filesystem::path& directory);

/// Writes plan.json and trajectory.csv (docs/plan-directory.md), and trajectory_uniform.csv if a step [s] is given; whole
/// or not at all, see write_folder_atomically. Throws FileError.
void write_plan(const std::filesystem::path& directory, const PlanRecord& record,
                std::optional<double> uniform_step = std::nullopt);

/// Reads what write_plan wrote; the task comes from the texts in plan.json. Throws InputError naming file and key for
/// anything missing or wrong, FileError.
PlanRecord read_plan(const std::filesystem::path& directory, const PackageSearch& search);

/// plan.json but for the texts of task and robot: what `prowl plan --json` prints.
std::string plan_report_json(const PlanRecord& record, const std::filesystem::path& directory);

}  // namespace prowl
