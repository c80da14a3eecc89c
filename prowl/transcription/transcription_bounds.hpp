#pragma once

#include <Eigen/Core>
#include <vector>

#include "prowl/trajectory/trajectory.hpp"
#include "prowl/transcription/decision_layout.hpp"

namespace prowl {

/// A chart R_chart of the base's rotation for each node: that of the boundary condition there, so that its bounds are
/// bounds on theta, else that of the guess. Both nodes of a phase switch get the same.
std::vector<Eigen::Matrix3d> rotation_charts(const DiscreteProblem& discrete, const Trajectory& guess);

struct VariableBounds {
  Eigen::VectorXd lower, upper;  ///< one a decision variable
};
/// Limits of the robot at every node, the boundary conditions at theirs, durations, and places of contacts that land.
/// Throws InputError where they contradict.
VariableBounds variable_bounds(const DiscreteProblem& discrete, const DecisionLayout& layout);

}  // namespace prowl
