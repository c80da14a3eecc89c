#include "prowl/feasibility/friction_support.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace prowl {

namespace {

using Eigen::Vector3d;

constexpr double kSmallestShortfall = 1e-6;

/// The force of a surface's friction cone that is nearest to f.
Vector3d nearest_in_cone(const Surface& surface, const Vector3d& f) {
  const double mu = surface.friction, normal = surface.normal.dot(f);
  const Vector3d tangential = f - normal * surface.normal;
  const double size = tangential.norm();
  if (size <= mu * normal) return f;
  if (mu * size <= -normal) return Vector3d::Zero();
  return (normal + mu * size) / (1.0 + mu * mu) * (surface.normal + mu / size * tangential);
}

/// up minus the nearest force of K: in turns, each cone takes the nearest force to what the others leave.
Vector3d what_is_left_of_up(const std::vector<Surface>& surfaces) {
  constexpr int kMostSweeps = 20000;
  constexpr double kAtRest = 1e-14;
  std::vector<Vector3d> forces(surfaces.size(), Vector3d::Zero());
  Vector3d left = Vector3d::UnitZ();
  for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
    const Vector3d before = left;
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
      left += forces[i];
      forces[i] = nearest_in_cone(surfaces[i], left);
      left -= forces[i];
    }
    if ((left - before).norm() <= kAtRest) break;
  }
  return left;
}

double angle_between(const Vector3d& unit, const Vector3d& other) {
  return std::atan2(unit.cross(other).norm(), unit.dot(other));
}

}  // namespace

std::optional<Slide> slide_on(const std::vector<Surface>& surfaces) {
  const Vector3d left = what_is_left_of_up(surfaces);
  if (left.norm() < kSmallestShortfall) return std::nullopt;
  Vector3d direction = left.normalized();

  // After the iteration d . f may be slightly above zero: the excess is removed along the mean normal e, which needs
  // e . f > 0 for all unit forces f of K.
  if (!surfaces.empty()) {
    Vector3d mean = Vector3d::Zero();
    for (const Surface& surface : surfaces) mean += surface.normal;
    if (mean.norm() < kSmallestShortfall) return std::nullopt;
    mean.normalize();
    double excess = 0.0, least = 1.0;
    for (const Surface& surface : surfaces) {
      const double half_angle = std::atan(surface.friction);
      excess = std::max(excess, std::cos(std::max(0.0, angle_between(direction, surface.normal) - half_angle)));
      least = std::min(least, std::cos(angle_between(mean, surface.normal) + half_angle));
    }
    if (!(least > kSmallestShortfall)) return std::nullopt;
    direction = (direction - excess / least * mean).normalized();
  }
  const double shortfall = direction.z();
  if (!(shortfall >= kSmallestShortfall)) return std::nullopt;
  return Slide{direction, shortfall};
}

double friction_factor_needed(const std::vector<Surface>& surfaces) {
  constexpr double kMost = 1e6, kPrecision = 1e-6;
  const auto carries = [&](double factor) {
    std::vector<Surface> rougher = surfaces;
    for (Surface& surface : rougher) surface.friction *= factor;
    return what_is_left_of_up(rougher).norm() < 1e-9;
  };
  if (carries(1.0)) return 1.0;
  double low = 1.0, high = 2.0;
  while (!carries(high)) {
    low = high;
    high *= 2.0;
    if (high > kMost) return std::numeric_limits<double>::infinity();
  }
  while (high - low > kPrecision * low) {
    const double middle = 0.5 * (low + high);
    (carries(middle) ? high : low) = middle;
  }
  return high;
}

}  // namespace prowl
