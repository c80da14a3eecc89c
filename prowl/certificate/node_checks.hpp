#pragma once

#include <vector>

#include "prowl/certificate/certificate.hpp"
#include "prowl/trajectory/trajectory.hpp"

namespace prowl {

/// Checks number, phases and sizes of the nodes, and that times increase inside a phase and agree at a phase
/// transition. All other checks rely on it.
CertificateCheck structure_check(const DiscreteProblem& discrete, const Trajectory& trajectory);

/// Checks that every number is finite and every base quaternion has norm 1. All checks below rely on it.
CertificateCheck finite_check(const Trajectory& trajectory);

/// Checks start, goals, phase durations, and continuity of the interpolated motion.
std::vector<CertificateCheck> node_checks(const DiscreteProblem& discrete, const Trajectory& trajectory);

}  // namespace prowl
