#include "prowl/simulation/ground_error.hpp"

namespace prowl {

std::vector<Surface> with_error(std::vector<Surface> surfaces, const Eigen::Vector3d& pivot, const GroundError& error) {
  const Eigen::Vector3d turn(error.tilt.x(), error.tilt.y(), 0.0);
  const Eigen::Matrix3d R = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
  for (Surface& surface : surfaces) {
    const Surface planned = surface;
    const auto moved = [&](const Eigen::Vector3d& p) -> Eigen::Vector3d {
      return pivot + R * (p - pivot) + error.height * Eigen::Vector3d::UnitZ();
    };
    surface.point = moved(planned.point);
    surface.normal = R * planned.normal;
    for (Eigen::Vector2d& corner : surface.patch) corner = surface.coordinates(moved(planned.at(corner)));
  }
  return surfaces;
}

}  // namespace prowl
