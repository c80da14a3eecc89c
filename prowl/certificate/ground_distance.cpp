#include "prowl/certificate/ground_distance.hpp"

#include <algorithm>
#include <cmath>

namespace prowl {

double distance_from_ground(const Surface& surface, const Eigen::Vector3d& point) {
  const double beside = distance_from_patch(surface, surface.coordinates(point));
  const double above = surface.distance(point);
  if (beside > 0.0 && above > 0.0) return std::hypot(beside, above);  // the edge is nearest
  return std::max(beside, above);
}

}  // namespace prowl
