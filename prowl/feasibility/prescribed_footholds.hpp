#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "prowl/motion/contact_schedule.hpp"

namespace prowl {

/// Position of the contact point in each stance, in the order of ContactSchedule::stances(), world frame [m]: its
/// position at the start, or over the given foothold. None if the optimiser chooses.
std::vector<std::optional<Eigen::Vector3d>> prescribed_footholds(const MotionProblem& problem,
                                                                 const ContactSchedule& schedule);

/// True if a condition is at a time of the phase, its ends included: those belong to the phases on both sides.
bool is_during(const BoundaryConstraint& constraint, int phase);

/// Bounds of a condition on the point p_base + R_base offset.
struct PointBounds {
  Eigen::Vector3d lower, upper;  ///< a box that contains it up to `slack` [m]; infinite where free
  double slack = 0.0;            ///< [m]
  bool is_finite() const { return lower.allFinite() && upper.allFinite(); }
  /// Least distance of the point from p [m], 0 if it may be at p.
  double distance(const Eigen::Vector3d& p) const;
  /// Least d . point that the condition allows; d a unit vector.
  double least_along(const Eigen::Vector3d& d) const;
};
PointBounds point_bounds(const BoundaryConstraint& constraint, const Eigen::Vector3d& offset);

}  // namespace prowl
