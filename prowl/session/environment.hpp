#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "prowl/model/urdf/package_path.hpp"

// What the front ends take from the machine that they run on; the layers below read neither environment nor globals.
namespace prowl {

/// Where to look for package://: `package_dirs` of the user, then AMENT_PREFIX_PATH/share, then ROS_PACKAGE_PATH; the
/// .venv of the clone that `program` was built in; and what was installed beside it. `program` is the file that the
/// front end was loaded from: the command, or the Python module.
PackageSearch package_search(const std::filesystem::path& program, const std::vector<std::string>& package_dirs);

/// Instruction sets of this processor that Prowl and its libraries may ask for, with blanks between: "AVX AVX2 FMA".
std::string processor_features();

/// Throws InputError if this processor lacks the instructions that the build uses (PROWL_SIMD). Call before anything
/// that computes.
void check_processor();

/// Throws InputError if MuJoCo cannot run on this processor; the reason alone.
void check_mujoco();
std::optional<std::string> why_no_mujoco();

/// "prowl", "vector instructions", "Pinocchio", "MuJoCo", "Eigen" -> version.
std::map<std::string, std::string> versions();
/// The same and the solver of that name (make_solver.hpp); throws InputError if there is none.
std::map<std::string, std::string> versions_with(const std::string& solver);
/// The same and all solvers that are installed: this loads their libraries.
std::map<std::string, std::string> all_versions();

}  // namespace prowl
