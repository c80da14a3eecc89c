#pragma once

#include <string>
#include <vector>

#include "prowl/mesh/mesh.hpp"
#include "prowl/motion/contact_schedule.hpp"
#include "prowl/motion/motion_problem.hpp"

namespace prowl {

/// One node of a motion. Two nodes that follow each other are the ends of a mesh interval if they are of one phase,
/// else a phase switch: two nodes at one time, h_out = 0 on one side and h_in = 0 on the other.
struct MeshNode {
  int phase = 0;
  int node = 0;        ///< within its phase, 0 ... intervals
  double time = 0.0;   ///< [s]; a phase of free duration counts with the middle of its range
  double h_in = 0.0;   ///< step before the node [s], 0 at the first node of a phase
  double h_out = 0.0;  ///< step after the node [s], 0 at the last node of a phase
};

/// A motion problem on one mesh, with all that follows from the two: built once a mesh, and read by the initial guess,
/// the nonlinear programs and the certificate. Nothing in it changes after its construction.
struct DiscreteProblem {
  /// Throws InputError as validate() does, and if the mesh does not fit the problem: another number of phases, or no
  /// node where a boundary condition is.
  DiscreteProblem(MotionProblem motion_problem, Mesh problem_mesh);

  MotionProblem problem;
  Mesh mesh;
  ContactSchedule schedule;
  std::vector<MeshNode> nodes;       ///< all nodes in the order of time, Mesh::num_nodes() of them
  std::vector<int> condition_nodes;  ///< of each boundary condition, its place in `nodes`

  int num_nodes() const { return static_cast<int>(nodes.size()); }
  const Phase& phase_of(int k) const { return problem.phases[nodes[k].phase]; }
  const PhaseMesh& phase_mesh_of(int k) const { return mesh.phases[nodes[k].phase]; }
  /// Whether nodes k and k + 1 are the ends of a mesh interval; else they are the sides of a phase switch.
  bool is_interval(int k) const { return nodes[k].h_out > 0.0; }
  std::string describe_node(int k) const;    ///< "phase 1 'stand', node 3"
  std::string describe_moment(int k) const;  ///< "phase 1 'stand', node 3, t = 0.600 s"
  /// Time of a boundary condition [s].
  double condition_time(std::size_t condition) const { return nodes[condition_nodes[condition]].time; }
};

/// Place of each boundary condition among the nodes of the mesh. Throws InputError if one has no node there.
std::vector<int> nodes_of_conditions(const MotionProblem& problem, const Mesh& mesh);

}  // namespace prowl
