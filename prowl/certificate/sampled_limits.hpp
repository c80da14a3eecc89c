#pragma once

#include <vector>

#include "prowl/certificate/certificate.hpp"
#include "prowl/certificate/contact_states.hpp"
#include "prowl/motion/motion_problem.hpp"

namespace prowl {

/// Checks contacts, forces, joint limits and the user's terms on a grid of at least ten pieces per mesh interval, of at
/// most 1 ms each, with both ends of every phase. Forces come from true_motion.hpp, not from the planner.
std::vector<CertificateCheck> sampled_limits(const DiscreteProblem& discrete, const Trajectory& trajectory,
                                             const ContactStates& states, PhaseDynamics& dynamics);

}  // namespace prowl
