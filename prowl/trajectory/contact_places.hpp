#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "prowl/motion/motion_problem.hpp"
#include "prowl/trajectory/mesh_interval.hpp"

namespace prowl {

/// What one contact of the robot does in one phase.
struct ContactPlace {
  std::optional<int> surface;  ///< the surface that it holds, if it is closed
  bool closes = false;         ///< closed here, open in the phase before
  double time = 0.0;           ///< when it closed [s]
  Eigen::Vector3d anchor = Eigen::Vector3d::Zero();  ///< where it was at the node where it closed, world frame [m]
  /// Surfaces that it must be outside of, of one of them at least: its own if closed; if open, the one that it left and
  /// the one that it will touch; if it never closes, all. Surfaces are planes without an edge: a foot that steps up
  /// starts below the plane of the step.
  std::vector<int> outside_one_of;
};

/// [phase][contact of the robot].
using ContactPlaces = std::vector<std::vector<ContactPlace>>;

ContactPlaces contact_places(const MotionProblem& problem, const Trajectory& trajectory, PhaseDynamics& dynamics);

}  // namespace prowl
