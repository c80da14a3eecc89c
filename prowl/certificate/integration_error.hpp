#pragma once

#include <vector>

#include "prowl/certificate/certificate.hpp"
#include "prowl/certificate/mesh_interval.hpp"
#include "prowl/model/robot_model.hpp"

namespace prowl {

/// Errors of the interpolated motion in the true dynamics ẋ = f(x, τ), x = (q, v), for each mesh interval:
///
///   e_i = ∫ |ẋ_i - f_i(x, τ)| dt / scale_i      (Betts, Practical Methods for Optimal Control, 4.7.4)
///
/// with five Gauss points; scale as in state_scale.hpp. e_i is O(h³) for the trapezoid. If the motion is wrong
/// everywhere, e_i still falls with h, and a fine mesh hides the fault; the sum of e_i over a second does not fall.
struct IntegrationErrors {
  std::vector<IntervalError> intervals;  ///< largest coordinate of each, in order
  std::vector<CertificateCheck> checks;  ///< the worst interval; the worst second, of one coordinate
};
IntegrationErrors integration_errors(const RobotModel& robot, const Trajectory& trajectory, PhaseDynamics& dynamics);

}  // namespace prowl
