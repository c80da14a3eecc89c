#include "prowl/model/nearest_in_patch.hpp"

#include <algorithm>
#include <limits>

namespace prowl {

Eigen::Vector2d nearest_in_patch(const Surface& surface, const Eigen::Vector2d& p) {
  if (surface.contains(p)) return p;
  Eigen::Vector2d nearest = p;
  double distance = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < surface.patch.size(); ++i) {
    const Eigen::Vector2d a = surface.patch[i], edge = surface.patch[(i + 1) % surface.patch.size()] - a;
    const Eigen::Vector2d on_edge = a + edge * std::clamp(edge.dot(p - a) / edge.squaredNorm(), 0.0, 1.0);
    if ((on_edge - p).norm() < distance) {
      distance = (on_edge - p).norm();
      nearest = on_edge;
    }
  }
  return nearest;
}

}  // namespace prowl
