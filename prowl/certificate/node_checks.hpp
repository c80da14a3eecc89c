#pragma once

#include <vector>

#include "prowl/certificate/certificate.hpp"
#include "prowl/trajectory/trajectory.hpp"

namespace prowl {

/// Whether the nodes are those that the problem asks for: number, phases, sizes, times that increase inside a phase and
/// agree at a switch. All other checks rely on it.
CertificateCheck structure_check(const DiscreteProblem& discrete, const Trajectory& trajectory);

/// Whether every number is finite and every base quaternion has norm 1. All checks below rely on it.
CertificateCheck finite_check(const Trajectory& trajectory);

/// What is asked of the nodes alone: start, goals, phase durations, and that the interpolated motion is continuous.
std::vector<CertificateCheck> node_checks(const DiscreteProblem& discrete, const Trajectory& trajectory);

}  // namespace prowl
