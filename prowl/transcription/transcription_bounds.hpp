#pragma once

#include <Eigen/Core>
#include <vector>

#include "prowl/trajectory/trajectory.hpp"
#include "prowl/transcription/decision_layout.hpp"

namespace prowl {

/// Chart R_chart of the base rotation at each node: from the boundary constraint there, so its
/// bounds are bounds on theta, else from the guess. Both nodes of a phase transition have the same
/// chart.
std::vector<Eigen::Matrix3d> rotation_charts(const DiscreteProblem& discrete, const Trajectory& guess);

struct VariableBounds {
  Eigen::VectorXd lower, upper;  ///< per decision variable
};
/// Bounds from robot limits at every node, boundary constraints at theirs, durations and free
/// footholds; no acceleration of the base where the robot stands at the end. Throws InputError for contradictions.
VariableBounds variable_bounds(const DiscreteProblem& discrete, const DecisionLayout& layout);

}  // namespace prowl
