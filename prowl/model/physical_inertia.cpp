#include "prowl/model/physical_inertia.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <cmath>

namespace prowl {

namespace {

constexpr double kLittle = 1e-12;  // of the moments, or [kg m^2]: a grain of dust

}  // namespace

std::optional<std::string> why_not_physical(double mass, const Eigen::Matrix3d& inertia) {
  if (!(mass > 0.0) || !std::isfinite(mass)) return fmt::format("the mass is {} kg; expected mass > 0", mass);
  if (!inertia.allFinite()) return "the inertia is not finite";
  Eigen::Vector3d moments = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(inertia).eigenvalues();
  for (double& moment : moments) {
    if (std::abs(moment) < 1e-12 * moments(2)) moment = 0.0;  // rounding of the eigenvalues
  }
  const std::string found = fmt::format("the principal moments of inertia are {:.4g}, {:.4g}, {:.4g} kg m^2; expected ",
                                        moments(0), moments(1), moments(2));
  if (!(moments(0) > 0.0)) return found + "all > 0";
  if (moments(0) + moments(1) < (1.0 - 1e-4) * moments(2)) {
    return found + "the sum of any two to reach the third (triangle inequality)";
  }
  return std::nullopt;
}

bool lacks_inertia(double mass, const Eigen::Matrix3d& inertia) {
  if (!why_not_physical(mass, inertia)) return false;
  if (mass == 0.0) return inertia.isZero(0.0);
  // Physical with a little inertia about all axes: only that is missing.
  return mass > 0.0 && inertia.allFinite() &&
         !why_not_physical(mass, inertia + kLittle * (inertia.trace() + 1.0) * Eigen::Matrix3d::Identity());
}

}  // namespace prowl
