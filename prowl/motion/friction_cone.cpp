#include "prowl/motion/friction_cone.hpp"

#include <cmath>

namespace prowl {

double FrictionCone::value(const Eigen::Vector3d& force) const {
  const double fn = normal.dot(force);
  return mu * fn - std::sqrt((force - fn * normal).squaredNorm() + smoothing * smoothing);
}

Eigen::Vector3d FrictionCone::gradient(const Eigen::Vector3d& force) const {
  const Eigen::Vector3d ft = force - normal.dot(force) * normal;
  return mu * normal - ft / std::sqrt(ft.squaredNorm() + smoothing * smoothing);
}

Eigen::Matrix3d FrictionCone::hessian(const Eigen::Vector3d& force) const {
  const Eigen::Vector3d ft = force - normal.dot(force) * normal;
  const double root = std::sqrt(ft.squaredNorm() + smoothing * smoothing);
  const Eigen::Matrix3d tangent = Eigen::Matrix3d::Identity() - normal * normal.transpose();
  return (ft * ft.transpose() / (root * root) - tangent) / root;
}

}  // namespace prowl
