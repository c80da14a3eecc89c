#pragma once

#include <vector>

#include "prowl/motion/motion_problem.hpp"
#include "prowl/trajectory/certificate.hpp"
#include "prowl/trajectory/mesh_interval.hpp"

namespace prowl {

/// Contacts, forces and joint limits on a grid of at least ten points a mesh interval and a step of at most 1 ms.
/// The forces are those that the true dynamics need for the interpolated (q, v, τ), not the planner's.
std::vector<CertificateCheck> sampled_limits(const MotionProblem& problem, const Trajectory& trajectory,
                                             PhaseDynamics& dynamics);

}  // namespace prowl
