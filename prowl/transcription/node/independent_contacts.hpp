#pragma once

#include <Eigen/Core>
#include <vector>

#include "prowl/mesh/discrete_problem.hpp"
#include "prowl/transcription/node/node_functions.hpp"

namespace prowl {

/// Indices of a maximal set of rows of `candidates` independent of `given` and of each other, in
/// order. Threshold as in Projector: kRankThreshold times the largest.
std::vector<int> independent_rows(const Eigen::MatrixXd& given, const Eigen::MatrixXd& candidates);

/// The Jacobian of contacts, three rows each, with each contact's rows along the frame of its surface.
Eigen::MatrixXd along_surfaces(const MotionProblem& problem, const std::vector<PhaseContact>& contacts,
                               const Eigen::MatrixXd& J);

/// Dependence of the contacts of a phase at the configuration q of its first node: staying contacts
/// first, then landing ones. One posture represents the phase, which is exact for dependence by
/// shape (flat feet, knee and foot). At a singular posture (straight legs) it drops a row that
/// matters once the legs bend; the contact then drifts, which the certificate detects.
PhaseContacts phase_contacts(const DiscreteProblem& discrete, int phase, const Eigen::VectorXd& q);

}  // namespace prowl
