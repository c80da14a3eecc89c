#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "prowl/dynamics/inverse_dynamics_hessian.hpp"

namespace prowl {

inline SpatialVector spatial(const Eigen::Vector3d& linear, const Eigen::Vector3d& angular) {
  SpatialVector result;
  result << linear, angular;
  return result;
}

/// Motion x motion: rate of b while a carries it along.
inline SpatialVector cross(const SpatialVector& a, const SpatialVector& b) {
  const Eigen::Vector3d a_linear = a.head<3>(), a_angular = a.tail<3>(), b_linear = b.head<3>(),
                        b_angular = b.tail<3>();
  return spatial(a_angular.cross(b_linear) + a_linear.cross(b_angular), a_angular.cross(b_angular));
}

/// Motion x* force, likewise; f may be a momentum. For any motion x,  x . (a x* f) = (x x a) . f
inline SpatialVector cross_force(const SpatialVector& a, const SpatialVector& f) {
  const Eigen::Vector3d a_linear = a.head<3>(), a_angular = a.tail<3>(), force = f.head<3>(), moment = f.tail<3>();
  return spatial(a_angular.cross(force), a_linear.cross(force) + a_angular.cross(moment));
}

}  // namespace prowl
