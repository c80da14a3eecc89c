#pragma once

#include <vector>

#include "prowl/mesh/mesh.hpp"
#include "prowl/motion/motion_problem.hpp"

namespace prowl {

/// A mesh that suits these errors of a motion on `mesh`, for each interval its error over what it may be
/// (error_parts()). The error of a step of the trapezoid falls with its cube, and two thirds of what it may be are
/// aimed at:
/// - An interval that is off by more becomes as many equal ones as that takes, at most four.
/// - Neighbours that would be off by little even as one (a quarter) become one, at most four, and no more than a
///   quarter of their phase; a goal between them keeps its node.
/// No step is more than four times as long as the one before it in its phase.
Mesh refined(const MotionProblem& problem, const Mesh& mesh, const std::vector<double>& parts);

}  // namespace prowl
