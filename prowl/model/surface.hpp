#pragma once

#include <Eigen/Core>
#include <string>

namespace prowl {

/// A plane in the world that contacts may touch: { p : normal . (p - point) = 0 }.
struct Surface {
  std::string name = "floor";
  Eigen::Vector3d point = Eigen::Vector3d::Zero();    ///< any point of the plane, world frame [m]
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit vector, world frame, points out of the ground [-]
  double friction = 0.5;                              ///< Coulomb coefficient mu > 0 [-]

  /// Signed distance of a world point p [m]; negative is inside the ground.
  double distance(const Eigen::Vector3d& p) const { return normal.dot(p - point); }
};

}  // namespace prowl
