#pragma once

#include <vector>

#include "prowl/motion/motion_problem.hpp"

namespace prowl {

/// One node of the mesh. Two nodes that follow each other are the ends of a mesh interval if they are of one phase,
/// else a phase switch: two nodes at one time, h_out = 0 on one side and h_in = 0 on the other.
struct MeshNode {
  int phase = 0;
  int node = 0;        ///< within its phase, 0 ... intervals
  double time = 0.0;   ///< [s]
  double h_in = 0.0;   ///< step before the node [s], 0 at the first node of a phase
  double h_out = 0.0;  ///< step after the node [s], 0 at the last node of a phase
};

/// All nodes of a motion in the order of time: sum over the phases of (intervals + 1).
struct Mesh {
  std::vector<MeshNode> nodes;

  int size() const { return static_cast<int>(nodes.size()); }
  /// Place of a node in `nodes`. The node must exist (validate() of the problem sees to it).
  int index(NodeRef ref) const;
};

/// For each phase what its number of intervals has to be a multiple of, so that every goal keeps its node.
std::vector<int> interval_divisors(const MotionProblem& problem);

/// Steps as Phase::shares has them. A phase of free duration gets the middle of its range.
Mesh make_mesh(const MotionProblem& problem);

}  // namespace prowl
