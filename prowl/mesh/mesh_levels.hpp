#pragma once

#include <functional>
#include <vector>

#include "prowl/mesh/mesh.hpp"
#include "prowl/motion/motion_problem.hpp"

namespace prowl {

/// For each phase what its number of intervals has to be a multiple of, so that every boundary condition keeps its
/// node.
std::vector<int> interval_divisors(const MotionProblem& problem, const Mesh& mesh);

/// Each phase on wanted(its intervals) of them, or more if goals need that for their nodes or it were less than four,
/// but not more than it has.
Mesh coarsened(const MotionProblem& problem, const Mesh& mesh, const std::function<int(int)>& wanted);

/// Meshes of growing fineness, the given one as the last: what is found on one is the guess of the next. Most
/// iterations go to finding the motion and few to refining it, and on a quarter of the intervals they cost a quarter.
/// Each level has a quarter of the intervals of the next, but no phase less than four
/// (if it has them at all), and a node for every goal; a level that would save less than half is left out.
std::vector<Mesh> mesh_levels(const MotionProblem& problem, const Mesh& mesh);

}  // namespace prowl
