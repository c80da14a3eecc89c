#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "prowl/task_file/task_file.hpp"
#include "prowl/task_file/toml/number_range.hpp"
#include "prowl/transcription/hessian_kind.hpp"

namespace prowl::cli {

// Groups of --help; what is in none is basic and comes first.
inline constexpr const char* kMeshOptions = "Mesh";
inline constexpr const char* kSolverOptions = "Solver";
inline constexpr const char* kOutputOptions = "Output";

// Options that several verbs have, in the same words.
/// An option that names a folder, which "" is none.
CLI::Option* add_folder(CLI::App& verb, const std::string& name, std::string& folder, const std::string& meaning);
void add_plan_directory(CLI::App& verb, std::string& directory);  ///< the folder that prowl plan wrote; required
void add_package_dirs(CLI::App& verb, std::vector<std::string>& folders);  ///< --package-dir, for package_search()
void add_json(CLI::App& verb, bool& json);                                 ///< --json, for print_json(), and --quiet
void add_solver_limits(CLI::App& verb, TaskOverrides& overrides);  ///< --max-time, --max-iterations, --tolerance
void add_hessian(CLI::App& verb, HessianKind& hessian);            ///< --hessian

/// --intervals; its range is that of the key in a task file.
CLI::Option* add_intervals(CLI::App& verb, TaskOverrides& overrides);
CLI::Validator interval_count();

/// A finite number in that range; CLI11's own checks let NaN through.
CLI::Validator number_in(const NumberRange& range);
CLI::Validator whole_number();  ///< of 64 bits; CLI11 takes -1, and what is larger, for the largest

/// What ends --help: "Examples:", one a line as typed, and what the exit status says. Each example is run by the tests.
void set_footer(CLI::App& verb, const std::vector<std::string>& examples, const std::string& exit_status);

}  // namespace prowl::cli
