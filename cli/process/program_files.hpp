#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "prowl/session/environment.hpp"

namespace prowl::cli {

/// The file of this program.
std::filesystem::path program_path();

/// PREFIX/share/prowl for PREFIX/bin/prowl, installed as well as in a build.
std::filesystem::path share_folder();

/// Where this program looks for package://, the folders of --package-dir first (session/environment.hpp).
PackageSearch package_search(const std::vector<std::string>& package_dirs);

}  // namespace prowl::cli
