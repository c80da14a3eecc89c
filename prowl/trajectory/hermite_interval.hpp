#pragma once

#include <Eigen/Core>

#include "prowl/trajectory/trajectory.hpp"

namespace prowl {

/// The motion inside an interval from `left` to `right` (one phase, right.time > left.time) by cubics through its ends,
/// at time left.time + s, 0 <= s <= h:
///
///   q(s) = q_left ⊕ φ(s)   φ: cubic with the displacements and rates of both ends
///   v(s)                   cubic with v and a of both ends;   a(s) = dv/ds
///   torque                 linear, or the parabola through `middle_torque`
///   force                  linear
///
/// It matches both ends exactly; errors within the interval appear as dq/ds ≠ v, and as a that
/// violates the dynamics. `middle_torque` (nu) may be null.
TrajectoryPoint hermite_point(const TrajectoryPoint& left, const TrajectoryPoint& right,
                              const Eigen::VectorXd* middle_torque, double s);

/// dq/ds (nv) in the tangent of configuration.hpp, like interpolated_rate() of trajectory.hpp.
Eigen::VectorXd hermite_rate(const TrajectoryPoint& left, const TrajectoryPoint& right, double s);

/// The torque alone (nu) [N m].
Eigen::VectorXd hermite_torque(const TrajectoryPoint& left, const TrajectoryPoint& right,
                               const Eigen::VectorXd* middle_torque, double s);

}  // namespace prowl
