#pragma once

#include <Eigen/Core>

#include "prowl/trajectory/trajectory.hpp"

namespace prowl {

/// The motion inside an interval from `left` to `right` (one phase, right.time > left.time) by cubics through its ends,
/// at time left.time + s, 0 <= s <= h:
///
///   q(s) = q_left (+) φ(s), φ the cubic with the displacements and rates of both ends;   v(s) the cubic with v and a
///   of both a(s) = dv/ds;   torque linear, or the parabola through `middle_torque` too;   force linear
///
/// It meets both ends exactly, for any motion: what is wrong in the interval shows as dq/ds ≠ v and as a that is not
/// the dynamics'. `middle_torque` may be null.
TrajectoryPoint hermite_point(const TrajectoryPoint& left, const TrajectoryPoint& right,
                              const Eigen::VectorXd* middle_torque, double s);

/// dq/ds of it in the tangent of configuration.hpp, as interpolated_rate() of trajectory.hpp.
Eigen::VectorXd hermite_rate(const TrajectoryPoint& left, const TrajectoryPoint& right, double s);

/// The torque alone [N m].
Eigen::VectorXd hermite_torque(const TrajectoryPoint& left, const TrajectoryPoint& right,
                               const Eigen::VectorXd* middle_torque, double s);

}  // namespace prowl
