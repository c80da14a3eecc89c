#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "prowl/model/body_tree.hpp"
#include "prowl/model/robot_model.hpp"

namespace prowl {

/// One shape of what a robot looks like, fixed to a body.
struct RobotVisual {
  enum class Kind { box, sphere, cylinder, capsule, mesh };

  std::string link;                                             ///< of the URDF
  int body = 0;                                                 ///< index into BodyTree::bodies
  Eigen::Isometry3d placement = Eigen::Isometry3d::Identity();  ///< of the shape in the body
  Kind kind = Kind::box;
  /// Edges of the box [m]; radius, twice, and length along z of cylinder and capsule (between the centres of its half
  /// balls) [m]; radius, three times, of the sphere [m]; factors on the mesh [-].
  Eigen::Vector3d size = Eigen::Vector3d::Ones();
  std::string mesh;                       ///< URI as in the URDF; "" if no mesh
  std::optional<Eigen::Vector3d> colour;  ///< red, green, blue, 0 ... 1; none where the URDF does not say
};

/// The <visual> elements of the robot's URDF, in the order of its links. Those of the world's side of a robot have
/// none.
std::vector<RobotVisual> robot_visuals(const RobotModel& robot);

/// The same of its <collision> elements; without colours.
std::vector<RobotVisual> robot_collisions(const RobotModel& robot);

/// A box of the body's mass and inertia, evenly filled: a stand-in for what cannot be drawn. None for a body without
/// mass.
std::optional<RobotVisual> inertia_box(const BodyTree& tree, int body);

}  // namespace prowl
