#pragma once

#include <vector>

#include "prowl/certificate/certificate.hpp"
#include "prowl/certificate/contact_places.hpp"
#include "prowl/motion/motion_problem.hpp"

namespace prowl {

/// Contacts, forces and joint limits on a grid of at least ten points a mesh interval and a step of at most 1 ms, both
/// ends of every phase included. The forces are those of true_motion.hpp, not the planner's.
std::vector<CertificateCheck> sampled_limits(const MotionProblem& problem, const Trajectory& trajectory,
                                             const ContactPlaces& places, PhaseDynamics& dynamics);

}  // namespace prowl
