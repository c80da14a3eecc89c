#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "prowl/transcription/node/placement_rows.hpp"

namespace prowl {

/// A direction in which the position c of a contact of the phase (its place in the phase's list) is held.
struct HeldDirection {
  int contact = 0;
  Eigen::Vector3d axis;  ///< unit vector, world frame
  double offset = 0.0;   ///< axis . c = offset where the contact is on its surface [m]
  std::string what;
};

/// How the contacts of a phase are on their surfaces, as Dai, Valenzuela, Tedrake 2014 have it: at a distance of zero
/// at the nodes, and not sliding from node to node. Of contacts that depend on each other (flat feet) as many
/// directions as are independent.
struct CentroidalContacts {
  std::vector<HeldDirection>
      landing;  ///< at the first node: normals of contacts that land, and where the task puts them
  std::vector<HeldDirection>
      distance;  ///< at every other node: normals. From where the start has it, if it never landed
  std::vector<HeldDirection> sliding;  ///< over every interval: axis . (c_k - c_k-1) = 0; offset has no meaning
};

/// `q` a configuration of the phase, in which it shows which contacts depend on each other.
CentroidalContacts centroidal_contacts(const DiscreteProblem& discrete, int phase, const Eigen::VectorXd& q,
                                       const std::vector<LandingAxes>& landing);

}  // namespace prowl
