#pragma once

#include <Eigen/Core>

#include "prowl/model/surface.hpp"

namespace prowl {

/// Signed distance of a world point from the solid under a surface, negative inside [m]. Under a plane without an edge
/// it is all that is below; under a patch, the prism of the patch that reaches down without end.
double distance_from_ground(const Surface& surface, const Eigen::Vector3d& point);

}  // namespace prowl
