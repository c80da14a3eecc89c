#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "prowl/simulation/simulation_options.hpp"
#include "prowl/task_file/task_file.hpp"
#include "prowl/task_file/toml/number_range.hpp"
#include "prowl/transcription/hessian_kind.hpp"

namespace prowl::cli {

// Groups of --help; basic options have no group and come first.
inline constexpr const char* kMeshOptions = "Mesh";
inline constexpr const char* kSolverOptions = "Solver";
inline constexpr const char* kOutputOptions = "Output";

// Options common to several verbs.
/// An option with a folder as value; rejects "".
CLI::Option* add_folder(CLI::App& verb, const std::string& name, std::string& folder, const std::string& meaning);
/// Refuses all other values, and names the nearest.
CLI::Validator one_of(const std::vector<std::string>& names);

/// The required task: a file, or the name of a shipped task, which becomes its path. An unknown name throws InputError
/// with the nearest one.
CLI::Option* add_task(CLI::App& verb, std::string& task);
void add_plan_directory(CLI::App& verb, std::string& directory);           ///< the required folder of a plan
void add_package_dirs(CLI::App& verb, std::vector<std::string>& folders);  ///< --package-dir, for package_search()
void add_allow_libraries(CLI::App& verb, bool& allows);                    ///< --allow-libraries, for OwnTerms
CLI::Option* add_only(CLI::App& verb, std::vector<std::string>& kinds);    ///< --only, for only()
/// Pushes of --push, four numbers each: time [s], impulse in x, y, z [N s]. Throws InputError for another count.
std::vector<Push> read_pushes(const std::vector<double>& numbers, double duration);
void add_json(CLI::App& verb, bool& json);                         ///< --json, for print_json(), and --quiet
void add_solver_limits(CLI::App& verb, TaskOverrides& overrides);  ///< --max-time, --max-iterations, --tolerance
void add_hessian(CLI::App& verb, HessianKind& hessian);            ///< --hessian

/// --intervals; range as of the key in a task file.
CLI::Option* add_intervals(CLI::App& verb, TaskOverrides& overrides);
CLI::Validator interval_count();

/// A finite number in that range; CLI11's own checks let NaN through.
CLI::Validator number_in(const NumberRange& range);
/// A whole number in that range; CLI11 would turn -1 and overflows into the largest.
CLI::Validator whole_number(std::uint64_t lower = 0, std::uint64_t upper = std::numeric_limits<std::uint64_t>::max());
CLI::Validator port_number();

/// Ends --help with "Examples:", one per line, and the meaning of the exit status. Tests run every
/// example.
void set_footer(CLI::App& verb, const std::vector<std::string>& examples, const std::string& exit_status);

}  // namespace prowl::cli
