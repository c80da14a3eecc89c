#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "prowl/model/body_tree.hpp"
#include "prowl/model/robot_model.hpp"

namespace prowl {

/// One visible shape of a robot, fixed to a body.
struct RobotVisual {
  enum class Kind { box, sphere, cylinder, capsule, mesh };

  std::string link;                                             ///< of the URDF
  int body = 0;                                                 ///< index into BodyTree::bodies
  Eigen::Isometry3d placement = Eigen::Isometry3d::Identity();  ///< of the shape in the body
  Kind kind = Kind::box;
  /// Box: edges [m]. Cylinder and capsule: radius, radius, length along z (of a capsule without its half balls) [m].
  /// Sphere: radius three times [m]. Mesh: factors [-].
  Eigen::Vector3d size = Eigen::Vector3d::Ones();
  std::string mesh;                       ///< URI as in the URDF; "" if no mesh
  std::optional<Eigen::Vector3d> colour;  ///< red, green, blue, 0 ... 1; none if the URDF gives none
};

/// The <visual> elements of the robot's URDF, in the order of its links, without links fixed to the world.
std::vector<RobotVisual> robot_visuals(const RobotModel& robot);

/// The same of its <collision> elements; without colours.
std::vector<RobotVisual> robot_collisions(const RobotModel& robot);

/// A homogeneous box with the body's mass and inertia, for a shape that cannot be drawn. None for a body without mass.
std::optional<RobotVisual> inertia_box(const BodyTree& tree, int body);

}  // namespace prowl
