#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "prowl/model/urdf/package_path.hpp"
#include "prowl/model/urdf/robot_visuals.hpp"

namespace prowl {

/// A convex shape of a robot, fixed to a body.
struct CollisionShape {
  RobotVisual shape;           ///< of a <collision> element; of a mesh the hull below, already scaled
  std::vector<float> hull;     ///< x y z of each vertex, in the axes of the shape [m]; only of meshes
  bool misses_ground = false;  ///< left out against surfaces: it is in the ground in the nominal posture
};

/// What collides besides the contacts of a robot, with ground and itself.
struct CollisionShapes {
  std::vector<CollisionShape> shapes;
  std::vector<std::pair<int, int>> apart;  ///< pairs of bodies that overlap in the nominal posture: left out
  std::vector<std::string> left_out;       ///< these and the shapes in the ground, in words
  std::vector<std::string> unreadable;     ///< links whose mesh cannot be read, with the reason: left out, too
};

/// Shapes of the robot's <collision> elements, meshes as their convex hulls of at most 64 vertices. Neighbouring bodies
/// never collide. Shapes on the frames of contacts are left out: the contacts stand for them.
std::shared_ptr<const CollisionShapes> collision_shapes(const RobotModel& robot, const PackageSearch& search);

}  // namespace prowl
