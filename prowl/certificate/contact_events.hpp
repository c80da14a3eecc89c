#pragma once

#include <vector>

#include "prowl/certificate/certificate.hpp"
#include "prowl/certificate/contact_states.hpp"

namespace prowl {

/// Checks each contact at the node where it lands (on its surface, in its patch, on its foothold) and at the last node
/// before it opens (no load). All contacts of the first phase land at the start.
std::vector<CertificateCheck> contact_event_checks(const DiscreteProblem& discrete, const Trajectory& trajectory,
                                                   const ContactStates& states, PhaseDynamics& dynamics);

}  // namespace prowl
