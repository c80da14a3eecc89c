#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>
#include <vector>

namespace prowl {

/// A plane in the world that contacts may touch, { p : normal . (p - point) = 0 }, or a convex polygon in it (patch).
struct Surface {
  std::string name = "floor";
  Eigen::Vector3d point = Eigen::Vector3d::Zero();    ///< any point of the plane, world frame [m]
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit vector, world frame, points out of the ground [-]
  double friction = 0.5;                              ///< Coulomb coefficient mu > 0 [-]
  /// Corners of a patch in surface coordinates [m], counterclockwise seen from outside; empty for the whole plane.
  std::vector<Eigen::Vector2d> patch = {};

  /// Fault of the corners of a patch, "" if none: fewer than three, not finite, not convex, clockwise.
  static std::string patch_fault(const std::vector<Eigen::Vector2d>& corners);

  /// Axes of the surface coordinates, unit vectors in the world: the first is x turned into the plane (y if x is
  /// along the normal), the second completes (first, second, normal) to a right-handed frame. World x y on level
  /// ground.
  Eigen::Matrix<double, 3, 2> axes() const {
    Eigen::Vector3d first = Eigen::Vector3d::UnitX() - normal.x() * normal;
    if (first.norm() < 1e-3) first = Eigen::Vector3d::UnitY() - normal.y() * normal;
    Eigen::Matrix<double, 3, 2> axes;
    axes.col(0) = first.normalized();
    axes.col(1) = normal.cross(axes.col(0));
    return axes;
  }
  /// axes() and the normal, as columns.
  Eigen::Matrix3d frame() const {
    Eigen::Matrix3d frame;
    frame << axes(), normal;
    return frame;
  }
  /// World point of surface coordinates (two lengths from `point` along axes()) at a height above the surface [m].
  Eigen::Vector3d at(const Eigen::Vector2d& coordinates, double height = 0.0) const {
    return point + axes() * coordinates + height * normal;
  }
  /// True if surface coordinates are inside the patch or on its edge; always true on a plane without an edge.
  bool contains(const Eigen::Vector2d& p) const;
  /// Surface coordinates of a world point [m].
  Eigen::Vector2d coordinates(const Eigen::Vector3d& p) const { return axes().transpose() * (p - point); }

  /// Signed distance of a world point p [m]; negative is inside the ground.
  double distance(const Eigen::Vector3d& p) const { return normal.dot(p - point); }
};

/// The point of a surface's patch nearest to surface coordinates p [m]: p itself inside it, or on a plane without an
/// edge.
Eigen::Vector2d nearest_in_patch(const Surface& surface, const Eigen::Vector2d& p);

/// Signed distance of surface coordinates p from the edge of the patch, negative inside [m]; -inf on a plane without an
/// edge.
double distance_from_patch(const Surface& surface, const Eigen::Vector2d& p);

}  // namespace prowl
