#pragma once

#include <optional>

#include "prowl/files/text_file.hpp"
#include "prowl/model/robot_description.hpp"
#include "prowl/model/robot_model.hpp"
#include "prowl/model/urdf/package_path.hpp"

namespace prowl {

/// How a robot file is read.
struct RobotReading {
  bool needs_contacts = true;                          ///< a robot may also be looked at before its contacts are known
  std::optional<SourceText> urdf_copy = std::nullopt;  ///< in place of the URDF, if that is not there
};

/// Reads a robot file (docs/robot-file.md). Throws InputError "file:line:column: key: ..." for anything wrong in it;
/// names of frames and joints are checked by load_robot only, as only the URDF knows them.
RobotDescription parse_robot_file(const SourceText& source, const PackageSearch& search,
                                  const RobotReading& reading = {});
RobotDescription read_robot_file(const std::filesystem::path& path, const PackageSearch& search);

/// The robot itself, with file and line on what RobotModel finds wrong.
RobotModel load_robot(const SourceText& source, const PackageSearch& search, const RobotReading& reading = {});

}  // namespace prowl
