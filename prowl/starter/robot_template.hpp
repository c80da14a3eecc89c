#pragma once

#include <filesystem>
#include <string>

#include "prowl/model/urdf/package_path.hpp"
#include "prowl/starter/new_robot.hpp"

namespace prowl {

/// Text of the robot file, with a comment on every guess. `urdf`: value of its key `urdf`.
std::string robot_template(const NewRobot& robot, const std::string& urdf, const std::filesystem::path& file);

/// Value of the key `urdf` for a robot file at `file`: package://NAME/PATH if the URDF names that
/// package and it is found from there; else a path relative to the file.
std::string urdf_reference(const RobotDescription& robot, const std::filesystem::path& file,
                           const PackageSearch& search);

}  // namespace prowl
