#pragma once

#include <vector>

#include "prowl/model/robot_model.hpp"
#include "prowl/trajectory/certificate.hpp"
#include "prowl/trajectory/mesh_interval.hpp"

namespace prowl {

/// How well the interpolated motion solves the true dynamics ẋ = f(x, τ), x = (q, v), inside each mesh interval:
///
///   e = max over i of  ∫ |ẋ_i - f_i(x, τ)| dt / scale_i      (Betts, Practical Methods for Optimal Control, 4.7.4)
///
/// by five Gauss points; scale as in state_scale.hpp. One entry an interval, in order; e is O(h³) for the trapezoid.
std::vector<IntervalError> integration_errors(const RobotModel& robot, const Trajectory& trajectory,
                                              PhaseDynamics& dynamics);

}  // namespace prowl
