#pragma once

#include <CLI/CLI.hpp>

namespace prowl::cli {

// Each adds its verb to the command line. `status` gets the exit status when the verb has run; errors are thrown.
void add_plan_command(CLI::App& app, int& status);
void add_check_command(CLI::App& app, int& status);
void add_robot_command(CLI::App& app, int& status);
void add_simulate_command(CLI::App& app, int& status);
void add_sweep_command(CLI::App& app, int& status);
void add_figures_command(CLI::App& app, int& status);
void add_report_command(CLI::App& app, int& status);

}  // namespace prowl::cli
