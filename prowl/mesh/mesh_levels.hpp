#pragma once

#include <functional>
#include <vector>

#include "prowl/mesh/mesh.hpp"
#include "prowl/motion/motion_problem.hpp"

namespace prowl {

/// For each phase: its number of intervals must be a multiple of this to keep a node for every boundary constraint.
std::vector<int> interval_divisors(const MotionProblem& problem, const Mesh& mesh);

/// Coarsens each phase to wanted(intervals) intervals: at least four, more if goals need them for their nodes, and
/// never more than it has.
Mesh coarsened(const MotionProblem& problem, const Mesh& mesh, const std::function<int(int)>& wanted);

/// Meshes of growing fineness up to the given one; the motion on each is the guess for the next. Most iterations find
/// the motion and few refine it; on a quarter of the intervals they cost a quarter. Each level has a quarter of the
/// next level's intervals, at least four per phase (if it has them), and a node for every goal. A level that would save
/// less than half is left out.
std::vector<Mesh> mesh_levels(const MotionProblem& problem, const Mesh& mesh);

}  // namespace prowl
