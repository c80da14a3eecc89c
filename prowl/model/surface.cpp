#include "prowl/model/surface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace prowl {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// From one corner of a patch to the next; the patch is on its left.
struct Edge {
  Eigen::Vector2d corner, along;

  Edge(const Surface& surface, std::size_t i)
      : corner(surface.patch[i]), along(surface.patch[(i + 1) % surface.patch.size()] - corner) {}

  /// The point of the edge nearest to p is corner + share along, 0 <= share <= 1.
  double nearest_share(const Eigen::Vector2d& p) const {
    return std::clamp(along.dot(p - corner) / along.squaredNorm(), 0.0, 1.0);
  }
};

}  // namespace

std::string Surface::patch_fault(const std::vector<Eigen::Vector2d>& corners) {
  if (corners.size() < 3) return fmt::format("a patch of {} corners is not allowed; need 3 or more", corners.size());
  double turned = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (!corners[i].allFinite()) return fmt::format("corner {} is not finite", i + 1);
    const Eigen::Vector2d& next = corners[(i + 1) % corners.size()];
    const Eigen::Vector2d edge = next - corners[i], following = corners[(i + 2) % corners.size()] - next;
    const double cross = edge.x() * following.y() - edge.y() * following.x();
    if (!(cross > 0.0)) {
      return fmt::format(
          "the corners after corner {} do not turn left; need a convex patch, counterclockwise seen from "
          "outside",
          i + 1);
    }
    turned += std::atan2(cross, edge.dot(following));
  }
  constexpr double kOneTurn = 6.283185307179586;
  if (turned > 1.5 * kOneTurn) return "the corners go around more than once; need a convex patch";
  return "";
}

bool Surface::contains(const Eigen::Vector2d& p) const {
  for (std::size_t i = 0; i < patch.size(); ++i) {
    const Edge edge(*this, i);
    const Eigen::Vector2d to = p - edge.corner;
    if (edge.along.x() * to.y() - edge.along.y() * to.x() < 0.0) return false;
  }
  return true;
}

Eigen::Vector2d nearest_in_patch(const Surface& surface, const Eigen::Vector2d& p) {
  if (surface.contains(p)) return p;
  Eigen::Vector2d nearest = p;
  double distance = kInfinity;
  for (std::size_t i = 0; i < surface.patch.size(); ++i) {
    const Edge edge(surface, i);
    const Eigen::Vector2d on_edge = edge.corner + edge.along * edge.nearest_share(p);
    if ((on_edge - p).norm() < distance) {
      distance = (on_edge - p).norm();
      nearest = on_edge;
    }
  }
  return nearest;
}

double distance_from_patch(const Surface& surface, const Eigen::Vector2d& p) {
  double beyond = -kInfinity;  // largest distance of p outside the line of an edge
  double nearest = kInfinity;  // distance of p to an edge
  for (std::size_t i = 0; i < surface.patch.size(); ++i) {
    const Edge edge(surface, i);
    const Eigen::Vector2d outward(edge.along.y(), -edge.along.x());
    beyond = std::max(beyond, outward.normalized().dot(p - edge.corner));
    nearest = std::min(nearest, (p - edge.corner - edge.nearest_share(p) * edge.along).norm());
  }
  return beyond > 0.0 ? nearest : beyond;
}

}  // namespace prowl
