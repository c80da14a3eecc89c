#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "prowl/model/surface.hpp"

namespace prowl {

/// Why contacts on some surfaces cannot carry a robot, wherever on them they are and however many: the sum K of the
/// friction cones { |f_t| <= mu f_n } does not hold the direction up. There is a direction d, |d| = 1, with
///
///   d . f <= 0 for all f in K,   d . up = shortfall > 0
///
/// so that the centre of mass accelerates along d by d . c̈ <= -g shortfall, whatever the forces are.
struct Slide {
  Eigen::Vector3d direction;  ///< d, world frame
  double shortfall = 0.0;     ///< in (0, 1]; 1 is free fall, and no surfaces
};

/// None where K holds up; nor where it nearly does (shortfall below 1e-6), nor where the cones together are so wide
/// (walls that face each other) that no direction can be made certain.
std::optional<Slide> slide_on(const std::vector<Surface>& surfaces);

/// The factor on all friction coefficients from which on K holds up, >= 1, to 1e-6; infinite where none does. On one
/// plane the coefficient needed is the tangent of its tilt.
double friction_factor_needed(const std::vector<Surface>& surfaces);

}  // namespace prowl
