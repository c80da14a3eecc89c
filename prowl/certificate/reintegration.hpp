#pragma once

#include <vector>

#include "prowl/certificate/certificate.hpp"
#include "prowl/certificate/mesh_interval.hpp"
#include "prowl/model/robot_model.hpp"

namespace prowl {

/// Integrates every mesh interval by itself, from its first node, with the planned torque (MeshInterval::torque) under
/// the true dynamics, adaptively (Dormand-Prince 5(4), tolerance 1e-10), and compares the end with the next node,
/// scaled as in state_scale.hpp. Not the whole motion: in open loop a standing robot falls, however good the plan.
struct ReintegrationErrors {
  std::vector<double> intervals;  ///< largest coordinate of each, in order
  CertificateCheck check;         ///< the worst interval
};
ReintegrationErrors reintegration_errors(const RobotModel& robot, const Trajectory& trajectory,
                                         PhaseDynamics& dynamics);

}  // namespace prowl
