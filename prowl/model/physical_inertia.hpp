#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

namespace prowl {

/// Reason why no body has this mass [kg] and this inertia about its centre of mass [kg m^2], or none: the mass and the
/// principal moments a <= b <= c must be positive, with a + b >= c (triangle inequality). c - a - b <= 1e-4 c is
/// allowed, because files round their numbers.
std::optional<std::string> why_not_physical(double mass, const Eigen::Matrix3d& inertia);

/// True for a massless frame, a point mass or a thin rod: not a body, but sound as a part of a mechanism if what moves
/// with it has inertia about all axes.
bool lacks_inertia(double mass, const Eigen::Matrix3d& inertia);

}  // namespace prowl
