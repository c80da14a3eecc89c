#pragma once

#include <vector>

#include "prowl/mesh/discrete_problem.hpp"

namespace prowl {

/// Indices in the decision variables z and the constraints g: the only index arithmetic of the
/// transcription.
///
/// z: per node  (base position, rotation vector theta, joints | v | a | tau | w), then shared variables:
///    the duration of each phase of free duration, two surface coordinates of each free foothold.
///    w: forces of dependent contact rows; their number depends on the phase.
/// g: per node its rows (NodeFunctions), then
///    per interval  (defects of q, nv rows | defects of v, nv rows),
///    per phase transition  (continuity of q, nv rows | of v, nv rows),
///    of a cycle  (end against start, q, nv rows | v, nv rows).
///
/// Rotation of the base: R = R_chart exp(theta), one chart per node, fixed by the initial guess or
/// by a boundary constraint there. So theta stays near zero, and a goal's bounds on rotation are
/// bounds on theta.
class DecisionLayout {
 public:
  /// `num_chosen`: size of w, per phase. `rows`: number of rows per node.
  DecisionLayout(const DiscreteProblem& discrete, const std::vector<int>& num_chosen, const std::vector<int>& rows);

  int num_variables() const { return num_variables_; }
  int num_constraints() const { return num_constraints_; }
  int num_nodes() const { return static_cast<int>(node_rows_.size()); }
  int nv() const { return nv_; }
  int nu() const { return nv_ - 6; }

  int node(int k) const { return nodes_[k]; }  ///< first variable of node k
  int node_size(int k) const { return nodes_[k + 1] - node(k); }
  int q(int k) const { return node(k); }
  int v(int k) const { return node(k) + nv_; }
  int a(int k) const { return node(k) + 2 * nv_; }
  int tau(int k) const { return node(k) + 3 * nv_; }
  int w(int k) const { return tau(k) + nu(); }
  int num_w(int k) const { return node_size(k) - 3 * nv_ - nu(); }

  int first_shared() const { return nodes_.back(); }
  int duration(int phase) const { return durations_[phase]; }    ///< -1 if it is fixed
  int foothold(int stance) const { return footholds_[stance]; }  ///< -1 if it does not land

  int node_row(int k) const { return node_rows_[k]; }  ///< first row of node k
  /// First row that links nodes k and k + 1: defects of an interval, or continuity at a phase
  /// transition.
  int link_row(int k) const { return first_link_row_ + 2 * nv_ * k; }
  int num_links() const { return num_nodes() - 1; }
  int closing_row() const { return first_closing_row_; }  ///< first of those that close a cycle, or the end of all

 private:
  int nv_;
  int num_variables_ = 0, num_constraints_ = 0, first_link_row_ = 0, first_closing_row_ = 0;
  std::vector<int> nodes_;  ///< first variable of each node; the end of the last
  std::vector<int> node_rows_, durations_, footholds_;
};

}  // namespace prowl
