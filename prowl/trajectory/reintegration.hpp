#pragma once

#include "prowl/model/robot_model.hpp"
#include "prowl/trajectory/certificate.hpp"
#include "prowl/trajectory/mesh_interval.hpp"

namespace prowl {

/// Integrates every mesh interval by itself, from its first node, with the planned torque (MeshInterval::torque) under the
/// true dynamics, adaptively (Dormand-Prince 5(4), tolerance 1e-10), and compares the end with the next node, scaled as
/// in state_scale.hpp. Not the whole motion: in open loop a standing robot falls, however good the plan.
CertificateCheck reintegration_check(const RobotModel& robot, const Trajectory& trajectory, PhaseDynamics& dynamics);

}  // namespace prowl
