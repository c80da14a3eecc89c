#pragma once

#include <map>
#include <string>
#include <vector>

#include "prowl/files/visual_mesh.hpp"
#include "prowl/model/urdf/package_path.hpp"
#include "prowl/model/urdf/robot_visuals.hpp"

namespace prowl {

/// What a robot looks like: its visuals, and the meshes that they name.
struct RobotLook {
  std::vector<RobotVisual> visuals;
  std::map<std::string, std::vector<VisualMesh>> meshes;  ///< by RobotVisual::mesh; one part a material
};

/// The look of the robot's URDF, its meshes simplified to 40000 triangles in all. A body whose mesh cannot be read gets
/// a box of its inertia, with a line in `warnings`.
RobotLook robot_look(const RobotModel& robot, const PackageSearch& search, std::vector<std::string>& warnings);

}  // namespace prowl
