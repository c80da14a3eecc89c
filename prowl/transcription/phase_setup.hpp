#pragma once

#include <Eigen/Core>
#include <vector>

#include "prowl/trajectory/trajectory.hpp"
#include "prowl/transcription/node/node_functions.hpp"

namespace prowl {

/// Dependence of the contacts of each phase at its first node of the guess.
std::vector<PhaseContacts> contacts_of_phases(const DiscreteProblem& discrete, const Trajectory& guess);

/// Anchors of each phase's contacts: landing contacts at the origin of their surface coordinates,
/// contacts held from the start at their start position. 3 rows per contact, world frame [m].
std::vector<Eigen::VectorXd> anchor_origins(const DiscreteProblem& discrete);

}  // namespace prowl
