#pragma once

#include <filesystem>
#include <string>

#include "prowl/model/urdf/package_path.hpp"
#include "prowl/starter/new_robot.hpp"

namespace prowl {

/// The robot file, with a comment on everything that was guessed. `urdf`: what the file is to say for its URDF.
std::string robot_template(const NewRobot& robot, const std::string& urdf, const std::filesystem::path& file);

/// What a robot file at `file` should say for this URDF: package://NAME/PATH if that is found from there, for a package
/// that the URDF itself names; else a path relative to the file.
std::string urdf_reference(const RobotDescription& robot, const std::filesystem::path& file,
                           const PackageSearch& search);

}  // namespace prowl
