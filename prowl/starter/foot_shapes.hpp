#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "prowl/model/robot_model.hpp"
#include "prowl/model/urdf/package_path.hpp"

namespace prowl {

/// A shape of the URDF on a body: points of its surface, or centre and radius of a sphere.
struct FootShape {
  std::string link;
  std::string kind;         ///< for comments: "sphere", "mesh foot.stl"
  Eigen::Matrix3Xd points;  ///< 3 x n, body frame [m]; the centre of a sphere
  double radius = 0.0;      ///< of a sphere [m]; else 0
  bool rolls = false;       ///< sphere, cylinder or capsule: never a sole
};

struct FootShapes {
  std::vector<FootShape> shapes;
  bool are_visual = false;           ///< <visual> shapes, as the body has no <collision>
  std::vector<std::string> missing;  ///< unreadable meshes, with the reason
};

/// <collision> shapes of each body of `bodies`; if it has none, its <visual> shapes.
std::vector<FootShapes> foot_shapes(const RobotModel& robot, const std::vector<int>& bodies,
                                    const PackageSearch& search);

}  // namespace prowl
