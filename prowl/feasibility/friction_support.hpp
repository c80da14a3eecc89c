#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "prowl/model/surface.hpp"

namespace prowl {

/// Proof that contacts on some surfaces cannot carry a robot, for any number and position of contacts: the sum K of the
/// friction cones { |f_t| <= mu f_n } does not contain the direction up. There is a direction d, |d| = 1, with
///
///   d . f <= 0 for all f in K,   d . up = shortfall > 0
///
/// so the centre of mass accelerates along d by d . c̈ <= -g shortfall for any forces.
struct Slide {
  Eigen::Vector3d direction;  ///< d, world frame
  double shortfall = 0.0;     ///< in (0, 1]; 1 without surfaces (free fall)
};

/// None if K contains up, or nearly does (shortfall below 1e-6), or if the cones together are so wide (walls that face
/// each other) that no direction is certain.
std::optional<Slide> slide_on(const std::vector<Surface>& surfaces);

/// Smallest factor >= 1 on all friction coefficients with which K contains up, to 1e-6; infinite if there is none. On
/// one plane the coefficient needed is the tangent of its tilt.
double friction_factor_needed(const std::vector<Surface>& surfaces);

}  // namespace prowl
