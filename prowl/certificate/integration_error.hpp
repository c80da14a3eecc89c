#pragma once

#include <vector>

#include "prowl/certificate/certificate.hpp"
#include "prowl/certificate/mesh_interval.hpp"
#include "prowl/model/robot_model.hpp"

namespace prowl {

/// How well the interpolated motion solves the true dynamics ẋ = f(x, τ), x = (q, v), inside each mesh interval:
///
///   e_i = ∫ |ẋ_i - f_i(x, τ)| dt / scale_i      (Betts, Practical Methods for Optimal Control, 4.7.4)
///
/// by five Gauss points; scale as in state_scale.hpp. The largest e_i of an interval is O(h³) for the trapezoid. For a
/// motion that is wrong everywhere it falls with h, so that a fine mesh hides the fault; the sum of e_i over a second
/// of the motion does not.
struct IntegrationErrors {
  std::vector<IntervalError> intervals;  ///< largest coordinate of each, in order
  std::vector<CertificateCheck> checks;  ///< the worst interval; the worst second, of one coordinate
};
IntegrationErrors integration_errors(const RobotModel& robot, const Trajectory& trajectory, PhaseDynamics& dynamics);

}  // namespace prowl
