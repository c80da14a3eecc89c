#pragma once

#include <Eigen/Core>

namespace prowl {

/// Friction cone of one point contact, smoothed at its tip:
///
///   c(f) = mu fn - sqrt(|ft|^2 + eps^2) >= 0,   fn = n . f,   ft = f - fn n
///
/// f is the force of the ground on the robot in the world frame [N], n the surface's unit normal. Any f with c(f) >= 0
/// lies inside the exact cone and has fn > 0: the ground only pushes.
struct FrictionCone {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double mu = 0.5;         ///< friction coefficient > 0 [-]
  double smoothing = 1.0;  ///< eps > 0 [N]; asks for at most eps/mu more normal force than the exact cone

  double value(const Eigen::Vector3d& force) const;
  Eigen::Vector3d gradient(const Eigen::Vector3d& force) const;
  Eigen::Matrix3d hessian(const Eigen::Vector3d& force) const;  ///< negative semidefinite: c is concave
};

}  // namespace prowl
