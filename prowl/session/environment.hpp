#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "prowl/model/urdf/package_path.hpp"

// Queries of the environment and the processor, for front ends. Lower layers read neither
// environment nor globals.
namespace prowl {

/// Folders to search for package://, in order: `package_dirs`, AMENT_PREFIX_PATH/share,
/// ROS_PACKAGE_PATH, the .venv of the clone that contains `program`, packages installed beside it.
/// `program`: file of the front end, i.e. the command or the Python module.
PackageSearch package_search(const std::filesystem::path& program, const std::vector<std::string>& package_dirs);

/// Instruction sets of this processor that Prowl and its libraries may need, separated by blanks:
/// "AVX AVX2 FMA".
std::string processor_features();

/// Throws InputError if MuJoCo cannot run on this processor.
void check_mujoco();
/// The reason; nullopt if MuJoCo can run.
std::optional<std::string> why_no_mujoco();

/// Files of Pinocchio and MuJoCo in folders of LD_LIBRARY_PATH: the dynamic linker may take them instead of those that
/// Prowl was built with.
std::vector<std::filesystem::path> foreign_libraries();

/// Versions by name: "prowl", "vector instructions", "Pinocchio", "MuJoCo", "Eigen".
std::map<std::string, std::string> versions();
/// The same and the named solver (make_solver.hpp). Throws InputError if it is unknown or not installed.
std::map<std::string, std::string> versions_with(const std::string& solver);
/// The same and all installed solvers; loads their libraries.
std::map<std::string, std::string> all_versions();

}  // namespace prowl
