#pragma once

#include <Eigen/Core>

#include "prowl/model/surface.hpp"

namespace prowl {

/// Signed distance of a world point from the solid under a surface, negative inside [m]. The solid is the half-space
/// below a plane, or the endless prism below a patch.
double distance_from_ground(const Surface& surface, const Eigen::Vector3d& point);

}  // namespace prowl
