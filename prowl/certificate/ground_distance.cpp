#include "prowl/certificate/ground_distance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace prowl {

double distance_from_patch(const Surface& surface, const Eigen::Vector2d& p) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double beyond = -kInfinity;  // how far p is outside of the edge's line, at most
  double nearest = kInfinity;  // point of an edge
  for (std::size_t i = 0; i < surface.patch.size(); ++i) {
    const Eigen::Vector2d corner = surface.patch[i];
    const Eigen::Vector2d edge = surface.patch[(i + 1) % surface.patch.size()] - corner;
    const Eigen::Vector2d outward(edge.y(), -edge.x());
    beyond = std::max(beyond, outward.normalized().dot(p - corner));
    const double along = std::clamp(edge.dot(p - corner) / edge.squaredNorm(), 0.0, 1.0);
    nearest = std::min(nearest, (p - corner - along * edge).norm());
  }
  return beyond > 0.0 ? nearest : beyond;
}

double distance_from_ground(const Surface& surface, const Eigen::Vector3d& point) {
  const double beside = distance_from_patch(surface, surface.coordinates(point));
  const double above = surface.distance(point);
  if (beside > 0.0 && above > 0.0) return std::hypot(beside, above);  // the edge is nearest
  return std::max(beside, above);
}

}  // namespace prowl
