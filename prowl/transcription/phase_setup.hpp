#pragma once

#include <Eigen/Core>
#include <vector>

#include "prowl/trajectory/trajectory.hpp"
#include "prowl/transcription/node/node_functions.hpp"

namespace prowl {

/// How the contacts of each phase depend on each other, at its first node of the guess.
std::vector<PhaseContacts> contacts_of_phases(const DiscreteProblem& discrete, const Trajectory& guess);

/// Anchors of each phase's contacts, those that land at the origin of their surface coordinates: a contact that is held
/// from the start stays at the place that the start has. 3 rows a contact, world frame [m].
std::vector<Eigen::VectorXd> anchor_origins(const DiscreteProblem& discrete);

}  // namespace prowl
