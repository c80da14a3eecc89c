#include "prowl/model/surface.hpp"

#include <fmt/format.h>

namespace prowl {

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

}  // namespace prowl
