#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "prowl/model/robot_model.hpp"
#include "prowl/model/urdf/package_path.hpp"

namespace prowl {

/// A shape of the URDF that is fixed to a body, as points of its surface; of a sphere, its centre and radius.
struct FootShape {
  std::string link;
  std::string kind;         ///< "sphere", "mesh foot.stl": for comments
  Eigen::Matrix3Xd points;  ///< in the body [m]; one, the centre, if it is a sphere
  double radius = 0.0;      ///< of a sphere [m]; 0: no sphere
  bool rolls = false;       ///< a sphere, cylinder or capsule: no sole, however fine it is cut into points
};

struct FootShapes {
  std::vector<FootShape> shapes;
  bool are_visual = false;           ///< the URDF has no <collision> there: what it looks like
  std::vector<std::string> missing;  ///< meshes that cannot be read, and why
};

/// The <collision> shapes of each of these bodies; its <visual> ones where it has none.
std::vector<FootShapes> foot_shapes(const RobotModel& robot, const std::vector<int>& bodies,
                                    const PackageSearch& search);

}  // namespace prowl
