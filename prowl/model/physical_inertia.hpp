#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

namespace prowl {

/// Why no distribution of matter has this mass [kg] and this inertia about its centre of mass [kg m^2]: the mass and
/// the principal moments a <= b <= c must be positive, with a + b >= c (triangle inequality). Empty if one does. A hair
/// of a + b < c is allowed (1e-4 c): files round their numbers.
std::optional<std::string> why_not_physical(double mass, const Eigen::Matrix3d& inertia);

}  // namespace prowl
