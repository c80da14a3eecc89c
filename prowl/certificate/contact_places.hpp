#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "prowl/certificate/mesh_interval.hpp"
#include "prowl/mesh/discrete_problem.hpp"

namespace prowl {

/// What one contact of the robot does in one phase.
struct ContactPlace {
  std::optional<int> surface;                        ///< the surface that it holds, if it is closed
  bool closes = false;                               ///< closed here, open (or elsewhere) in the phase before
  bool opens = false;                                ///< closed here, open in the phase after
  bool swings = false;                               ///< open here, but closed some time before and some time after
  double time = 0.0;                                 ///< when it closed [s]
  Eigen::Vector3d anchor = Eigen::Vector3d::Zero();  ///< where it was at the node where it closed, world frame [m]
};

/// [phase][contact of the robot].
using ContactPlaces = std::vector<std::vector<ContactPlace>>;

ContactPlaces contact_places(const DiscreteProblem& discrete, const Trajectory& trajectory, PhaseDynamics& dynamics);

}  // namespace prowl
