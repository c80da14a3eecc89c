#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "prowl/session/environment.hpp"

namespace prowl::cli {

/// Path of this program.
std::filesystem::path program_path();

/// PREFIX/share/prowl for PREFIX/bin/prowl, both installed and in a build.
std::filesystem::path share_folder();

/// Folders to search for package://, --package-dir first (session/environment.hpp).
PackageSearch package_search(const std::vector<std::string>& package_dirs);

/// Path of the shipped task of that name, such as "hyq/crouch"; `name` itself if it is a file or ends in
/// .toml. Throws InputError with the nearest shipped task otherwise.
std::string find_task(const std::string& name);
/// The same of a shipped robot, such as "hyq".
std::string find_robot(const std::string& name);

}  // namespace prowl::cli
