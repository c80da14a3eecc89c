#pragma once

#include "prowl/model/surface.hpp"

namespace prowl {

/// The point of a surface's patch nearest to surface coordinates p [m]: p itself inside it, or on a plane without an
/// edge.
Eigen::Vector2d nearest_in_patch(const Surface& surface, const Eigen::Vector2d& p);

}  // namespace prowl
