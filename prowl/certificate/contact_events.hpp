#pragma once

#include <vector>

#include "prowl/certificate/certificate.hpp"
#include "prowl/certificate/contact_places.hpp"

namespace prowl {

/// What is asked of a contact at the node where it closes (on its surface, inside its patch, at its prescribed place)
/// and at the last before it opens (no load). At the start of the motion all contacts of the first phase close.
std::vector<CertificateCheck> contact_event_checks(const DiscreteProblem& discrete, const Trajectory& trajectory,
                                                   const ContactPlaces& places, PhaseDynamics& dynamics);

}  // namespace prowl
