#pragma once

#include <Eigen/Core>
#include <vector>

#include "prowl/mesh/discrete_problem.hpp"
#include "prowl/transcription/node/node_functions.hpp"

namespace prowl {

/// Rows of `candidates` that are independent of the rows of `given` and of each other, as many as there are, in order.
/// Rows count as dependent where Projector would: kRankThreshold of the largest.
std::vector<int> independent_rows(const Eigen::MatrixXd& given, const Eigen::MatrixXd& candidates);

/// How the contacts of a phase depend on each other, at configuration q of its first node: contacts that stay come
/// first, those that land add what is left. One posture stands for the phase. It does where dependence is a matter of
/// the robot's shape (flat feet, knee and foot); from a singular one (straight legs) a row stays out that counts as
/// soon as the legs bend, and the contact drifts, which the certificate finds.
PhaseContacts phase_contacts(const DiscreteProblem& discrete, int phase, const Eigen::VectorXd& q);

}  // namespace prowl
