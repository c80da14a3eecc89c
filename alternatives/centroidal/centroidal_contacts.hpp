#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "prowl/transcription/node/placement_rows.hpp"

namespace prowl {

/// A direction in which the position c of a contact is fixed.
struct HeldDirection {
  int contact = 0;       ///< index in the phase
  Eigen::Vector3d axis;  ///< unit vector, world frame
  double offset = 0.0;   ///< axis . c = offset on the surface [m]
  std::string what;
};

/// Contact constraints of a phase as in Dai, Valenzuela, Tedrake 2014: zero distance at the nodes,
/// no sliding between nodes. Dependent contacts (flat feet) keep only independent directions.
struct CentroidalContacts {
  /// At the first node: normals of landing contacts, and all directions of prescribed footholds.
  std::vector<HeldDirection> landing;
  /// At every other node: normals; offset from the start for contacts that never landed.
  std::vector<HeldDirection> distance;
  std::vector<HeldDirection> sliding;  ///< over every interval: axis . (c_k - c_k-1) = 0; offset unused
};

/// `q`: configuration of the phase at which the dependence of contacts is determined.
CentroidalContacts centroidal_contacts(const DiscreteProblem& discrete, int phase, const Eigen::VectorXd& q,
                                       const std::vector<LandingAxes>& landing);

}  // namespace prowl
