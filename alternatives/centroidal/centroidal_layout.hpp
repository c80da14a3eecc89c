#pragma once

#include <vector>

#include "prowl/mesh/discrete_problem.hpp"

namespace prowl {

/// Indices into the variables of one node: q (base position, theta, joints), v, then as listed.
/// Accelerations, momentum rates and forces exist only where an interval ends, not at the first
/// node of a phase (-1).
struct CentroidalColumns {
  CentroidalColumns(int nv, int contacts, bool ends_interval);

  int v, com, com_velocity, momentum, contacts;
  int com_acceleration, momentum_rate, forces;
  int size;
  bool ends_interval() const { return forces >= 0; }
};

/// Indices in the decision variables z and the constraints g of the centroidal program.
///
/// z: variables of each node, then the duration of each phase of free duration.
/// g: rows of each node (CentroidalNode); per interval (q, nv | h | r | r' | no sliding); per phase
///    transition (continuity of q, nv | of v, nv | of r'): h and r follow from q and v.
class CentroidalLayout {
 public:
  /// `rows`: per node; `sliding_rows`: per interval of each phase.
  CentroidalLayout(const DiscreteProblem& discrete, const std::vector<int>& rows, const std::vector<int>& sliding_rows);

  int num_variables() const { return num_variables_; }
  int num_constraints() const { return link_rows_.back(); }
  int num_nodes() const { return static_cast<int>(nodes_.size()); }
  int num_links() const { return num_nodes() - 1; }

  int node(int k) const { return nodes_[k]; }  ///< first variable of node k
  const CentroidalColumns& columns(int k) const { return columns_[k]; }
  int first_shared() const { return first_shared_; }
  int duration(int phase) const { return durations_[phase]; }  ///< -1 if it is fixed

  int node_row(int k) const { return node_rows_[k]; }  ///< first row of node k
  int link_row(int k) const { return link_rows_[k]; }  ///< first row that links nodes k and k + 1; or the end

 private:
  int num_variables_ = 0, first_shared_ = 0;
  std::vector<CentroidalColumns> columns_;
  std::vector<int> nodes_, durations_, node_rows_, link_rows_;
};

}  // namespace prowl
