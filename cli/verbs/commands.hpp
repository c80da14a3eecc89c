#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>

#include "prowl/plan_folder/plan_folder.hpp"

namespace prowl::cli {

// Each adds a verb to the command line. Running the verb sets `status` to the exit status; errors
// are thrown.
void add_plan_command(CLI::App& app, int& status);
void add_check_command(CLI::App& app, int& status);
void add_diagnose_command(CLI::App& app, int& status);
void add_robot_command(CLI::App& app, int& status);
void add_simulate_command(CLI::App& app, int& status);
void add_sweep_command(CLI::App& app, int& status);
void add_mpc_command(CLI::App& app, int& status);
void add_compare_command(CLI::App& app, int& status);
void add_figures_command(CLI::App& app, int& status);
void add_report_command(CLI::App& app, int& status);
void add_view_command(CLI::App& app, int& status);
void add_export_command(CLI::App& app, int& status);
void add_batch_command(CLI::App& app, int& status);
void add_library_command(CLI::App& app, int& status);
void add_retarget_command(CLI::App& app, int& status);
void add_new_command(CLI::App& app, int& status);
void add_doctor_command(CLI::App& app, int& status);
void add_completion_command(CLI::App& app, int& status);

struct WrittenReport {
  std::size_t bytes;
  bool has_simulation;
  std::vector<std::string> warnings;
};

/// Writes the report of a plan and its folder to `out` (see prowl report), with a message on
/// stderr.
WrittenReport write_report(const PlanRecord& plan, const std::filesystem::path& directory,
                           const std::filesystem::path& out, const PackageSearch& search);

}  // namespace prowl::cli
