#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "prowl/motion/contact_schedule.hpp"

namespace prowl {

/// Where each stance has its contact point, in the order of ContactSchedule::stances(), world frame [m]: where it is at
/// the start, or over the place that the task gives. None where the optimiser chooses.
std::vector<std::optional<Eigen::Vector3d>> prescribed_places(const MotionProblem& problem,
                                                              const ContactSchedule& schedule);

/// Whether a condition is about a time of the phase, its ends included: those belong to the phases on both sides.
bool is_during(const BoundaryCondition& condition, int phase);

/// What a condition says of the point p_base + R_base offset.
struct PointBounds {
  Eigen::Vector3d lower, upper;  ///< a box that holds it but for `slack` [m]; infinite where free
  double slack = 0.0;            ///< [m]
  bool is_finite() const { return lower.allFinite() && upper.allFinite(); }
  /// Least distance of the point from p [m], 0 if it may be there.
  double distance(const Eigen::Vector3d& p) const;
  /// Least d . point over all that the condition allows; d a unit vector.
  double least_along(const Eigen::Vector3d& d) const;
};
PointBounds point_bounds(const BoundaryCondition& condition, const Eigen::Vector3d& offset);

}  // namespace prowl
