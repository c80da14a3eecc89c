#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "prowl/certificate/mesh_interval.hpp"
#include "prowl/mesh/discrete_problem.hpp"

namespace prowl {

/// State of one contact of the robot in one phase.
struct ContactState {
  std::optional<int> surface;                        ///< of the surface that it holds, if any
  bool closes = false;                               ///< lands: it was open or elsewhere in the phase before
  bool opens = false;                                ///< stands here, is open in the phase after
  bool swings = false;                               ///< open here, stands in some phase before and some after
  double time = 0.0;                                 ///< of its landing [s]
  Eigen::Vector3d anchor = Eigen::Vector3d::Zero();  ///< position at its landing, world frame [m]
};

/// [phase][contact of the robot].
using ContactStates = std::vector<std::vector<ContactState>>;

ContactStates contact_states(const DiscreteProblem& discrete, const Trajectory& trajectory, PhaseDynamics& dynamics);

}  // namespace prowl
