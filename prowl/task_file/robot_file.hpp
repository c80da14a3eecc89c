#pragma once

#include <optional>

#include "prowl/files/text_file.hpp"
#include "prowl/model/robot_description.hpp"
#include "prowl/model/robot_model.hpp"
#include "prowl/model/urdf/package_path.hpp"

namespace prowl {

/// Options of reading a robot file.
struct RobotFileOptions {
  bool needs_contacts = true;                          ///< false: accept a robot without contacts, to inspect it
  std::optional<SourceText> urdf_copy = std::nullopt;  ///< used if the URDF file does not exist
};

/// Reads a robot file (docs/robot-file.md). Throws InputError "file:line:column: key: ..." for
/// errors in it. Only load_robot() checks names of frames and joints, as only the URDF defines
/// them.
RobotDescription parse_robot_file(const SourceText& source, const PackageSearch& search,
                                  const RobotFileOptions& options = {});
RobotDescription read_robot_file(const std::filesystem::path& path, const PackageSearch& search);

/// Builds the robot; adds file and line to errors of RobotModel.
RobotModel load_robot(const SourceText& source, const PackageSearch& search, const RobotFileOptions& options = {});

}  // namespace prowl
