#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace prowl {

/// Search path for package:// besides the folders around a robot file. A library does not read the environment: the
/// command fills this in from its options, AMENT_PREFIX_PATH, ROS_PACKAGE_PATH and the working directory.
struct PackageSearch {
  std::vector<std::filesystem::path> folders;         ///< in order; each contains packages or is one
  std::filesystem::path working_directory;            ///< may be empty; its ancestors' .venv are searched
  std::filesystem::path clone = {};                   ///< may be empty; its .venv is searched, too
  std::vector<std::filesystem::path> installed = {};  ///< like `folders`, searched last: installed with Prowl
};

/// Absolute path of the file that `uri` names in the robot file `robot_file`. A path is relative to the robot file;
/// package://NAME/REST is FOLDER/NAME/REST, or FOLDER/REST if FOLDER is called NAME, in the first folder that contains
/// it: `package_dirs`, search.folders, the ancestors of the robot file, then the shared folder of the wheels in a .venv
/// of an ancestor of the robot file or of the working directory, or in that of search.clone; search.installed. Throws
/// InputError (without file and line) that lists every folder tried.
std::filesystem::path resolve_uri(const std::string& uri, const std::filesystem::path& robot_file,
                                  const std::vector<std::filesystem::path>& package_dirs, const PackageSearch& search);

}  // namespace prowl
