#pragma once

#include <string>
#include <vector>

#include "prowl/mesh/mesh.hpp"
#include "prowl/motion/contact_schedule.hpp"
#include "prowl/motion/motion_problem.hpp"

namespace prowl {

/// One node of a motion. Successive nodes of one phase are the ends of a mesh interval. Otherwise they are a phase
/// transition: two nodes at one time, h_out = 0 at the first and h_in = 0 at the second.
struct MeshNode {
  int phase = 0;
  int node = 0;        ///< within its phase, 0 ... intervals
  double time = 0.0;   ///< [s]; a free duration counts as the middle of its range
  double h_in = 0.0;   ///< step before the node [s], 0 at the first node of a phase
  double h_out = 0.0;  ///< step after the node [s], 0 at the last node of a phase
};

/// A motion problem on one mesh, with data derived from both: built once per mesh, read by the initial guess, the
/// nonlinear programs and the certificate. Immutable after construction.
struct DiscreteProblem {
  /// Throws InputError as validate() does, and if the mesh does not fit the problem: another number of phases, or a
  /// boundary constraint without a node.
  DiscreteProblem(MotionProblem motion_problem, Mesh problem_mesh);

  MotionProblem problem;
  Mesh mesh;
  ContactSchedule schedule;
  std::vector<MeshNode> nodes;      ///< all nodes in the order of time, Mesh::num_nodes() of them
  std::vector<int> boundary_nodes;  ///< index in `nodes` of each boundary constraint

  int num_nodes() const { return static_cast<int>(nodes.size()); }
  const Phase& phase_of(int k) const { return problem.phases[nodes[k].phase]; }
  const PhaseMesh& phase_mesh_of(int k) const { return mesh.phases[nodes[k].phase]; }
  /// True if nodes k and k + 1 are the ends of a mesh interval; otherwise they are a phase transition.
  bool is_interval(int k) const { return nodes[k].h_out > 0.0; }
  /// Whether a term counts at a node of a phase.
  bool holds(const TermUse& use, int phase, int node) const {
    return use.holds_at(phase, mesh.phases[phase].node_time(node, 1.0));
  }
  std::string describe_node(int k) const;    ///< "phase 1 'stand', node 3"
  std::string describe_moment(int k) const;  ///< "phase 1 'stand', node 3, t = 0.600 s"
  /// Time of a boundary constraint [s].
  double boundary_time(std::size_t constraint) const { return nodes[boundary_nodes[constraint]].time; }
};

/// Node index of each boundary constraint. Throws InputError if a condition, or an end of a term, is not
/// at a node.
std::vector<int> find_boundary_nodes(const MotionProblem& problem, const Mesh& mesh);

}  // namespace prowl
