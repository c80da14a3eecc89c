#pragma once

#include <vector>

#include "prowl/mesh/mesh.hpp"
#include "prowl/motion/motion_problem.hpp"

namespace prowl {

/// A mesh that suits a motion on `mesh`; `parts` contains error over tolerance of each interval (error_parts()). The
/// error of a trapezoidal step falls with its cube. The aim is two thirds of the tolerance:
/// - An interval above that is split into as many equal ones as it needs, at most four.
/// - Neighbours that would stay below a quarter even as one are merged: at most four, and at most a quarter of their
///   phase; a goal between them keeps its node.
/// No step is more than four times as long as the one before it in its phase.
Mesh refined(const MotionProblem& problem, const Mesh& mesh, const std::vector<double>& parts);

}  // namespace prowl
