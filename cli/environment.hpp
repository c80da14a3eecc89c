#pragma once

#include <map>
#include <string>
#include <vector>

#include "prowl/io/package_path.hpp"

namespace prowl::cli {

/// Where to look for package://: --package-dir, then AMENT_PREFIX_PATH/share, then ROS_PACKAGE_PATH; the .venv of
/// the clone that this program was built in; and what was installed beside it.
PackageSearch package_search(const std::vector<std::string>& package_dirs);

/// Throws InputError if this processor lacks the instructions that the build uses (PROWL_SIMD).
void check_processor();

/// "prowl", "vector instructions", "Pinocchio", "MuJoCo", "Eigen" and the name of each solver -> version.
std::map<std::string, std::string> versions();

}  // namespace prowl::cli
