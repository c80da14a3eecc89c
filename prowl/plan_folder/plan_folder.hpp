#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "prowl/model/urdf/package_path.hpp"
#include "prowl/session/plan_record.hpp"

namespace prowl {

/// Default name of the report within the folder of a plan (report_page/).
inline constexpr const char* kReportFile = "report.html";

/// True if the folder contains a good plan, by its plan.json.
bool holds_good_plan(const std::filesystem::path& directory);

/// Throws FileError if write_plan could not replace this folder; for a check before a solve.
void check_plan_directory(const std::filesystem::path& directory);

/// Writes plan.json and trajectory.csv (docs/plan-directory.md), tracker.bin if there are gains, and
/// trajectory_uniform.csv if a step [s] is given; whole or not at all, see write_folder_atomically. Throws FileError.
void write_plan(const std::filesystem::path& directory, const PlanRecord& record,
                std::optional<double> uniform_step = std::nullopt);

/// Reads the files of write_plan, except tracker.bin and trajectory_uniform.csv. The task comes from the texts in
/// plan.json, and so does the URDF if its file is gone. Throws InputError with file and key for anything missing, wrong
/// or changed since; FileError.
PlanRecord read_plan(const std::filesystem::path& directory, const PackageSearch& search,
                     const OwnTerms& own_terms = {});

/// plan.json without the texts of task, robot and URDF, for `prowl plan --json`; with "directory" unless that is empty.
std::string plan_report_json(const PlanRecord& record, const std::filesystem::path& directory);

}  // namespace prowl
