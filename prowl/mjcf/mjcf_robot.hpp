#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace prowl {

/// The robot of an MJCF file, as Prowl reads robots.
struct MjcfRobot {
  std::string name;  ///< of the model
  /// A URDF: links, joints with ranges and torque limits, inertias, shapes. Numbers have all digits. A joint without a
  /// range or torque limit has 0 there, every joint has velocity 0: MJCF has none.
  std::string urdf;
  std::map<std::string, double> armature;  ///< by joint name, where not 0 [kg m^2] or [kg]
  std::vector<std::string> notes;          ///< sentences: what the file contains and a URDF cannot
};

/// True if `xml` is MJCF: its first element is <mujoco>.
bool is_mjcf(const std::string& xml);

/// Compiles the file with MuJoCo, which applies its defaults and includes, and describes the result. Paths of meshes
/// are relative to `folder`, where the URDF will be. A body with several joints becomes a chain of links.
///
/// Throws InputError, with MuJoCo's reason, if it cannot read the file; and unless its moving bodies are one tree of
/// hinges and slides behind one free joint.
MjcfRobot read_mjcf(const std::filesystem::path& file, const std::filesystem::path& folder);

}  // namespace prowl
