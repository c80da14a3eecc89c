#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "prowl/model/urdf/package_path.hpp"
#include "prowl/session/plan_record.hpp"

namespace prowl {

/// Name of the report within the folder of a plan, unless asked for another (report_page/).
inline constexpr const char* kReportFile = "report.html";

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
