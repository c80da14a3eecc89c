#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>

#include "prowl/plan_folder/plan_folder.hpp"

namespace prowl::cli {

// Each adds its verb to the command line. `status` gets the exit status when the verb has run; errors are thrown.
void add_plan_command(CLI::App& app, int& status);
void add_check_command(CLI::App& app, int& status);
void add_diagnose_command(CLI::App& app, int& status);
void add_robot_command(CLI::App& app, int& status);
void add_simulate_command(CLI::App& app, int& status);
void add_sweep_command(CLI::App& app, int& status);
void add_compare_command(CLI::App& app, int& status);
void add_figures_command(CLI::App& app, int& status);
void add_report_command(CLI::App& app, int& status);
void add_view_command(CLI::App& app, int& status);
void add_export_command(CLI::App& app, int& status);
void add_new_command(CLI::App& app, int& status);
void add_doctor_command(CLI::App& app, int& status);
void add_completion_command(CLI::App& app, int& status);

struct WrittenReport {
  std::size_t bytes;
  bool has_simulation;
  std::vector<std::string> warnings;
};

/// Writes `out`, the report of a plan and of what else is in its folder (see prowl report), and says so on stderr.
WrittenReport write_report(const PlanRecord& plan, const std::filesystem::path& directory,
                           const std::filesystem::path& out, const PackageSearch& search);

}  // namespace prowl::cli
