#pragma once

#include <vector>

#include "prowl/mesh/discrete_problem.hpp"

namespace prowl {

/// Where everything is in the decision variables z and in the constraints g: the only index arithmetic of the
/// transcription.
///
/// z: for each node of the mesh  (base position, rotation vector theta, joints | v | a | tau | w), then what nodes
/// share:
///    for each phase of free duration its duration, for each contact that lands two surface coordinates of its place.
///    w are the forces of dependent contact rows, of a number that goes with the phase.
/// g: for each node its rows (NodeFunctions),
///    for each interval  (defects of q, nv rows | defects of v, nv rows),
///    for each phase switch  (continuity of q, nv rows | of v, nv rows).
///
/// The base's rotation is R = R_chart exp(theta), with a chart of its own for each node (fixed by the initial guess or
/// by a boundary condition there), so that theta stays near zero and bounds on a goal's rotation are bounds on theta.
class DecisionLayout {
 public:
  /// `num_chosen`: size of w, one a phase. `rows`: of each node.
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
  int duration(int phase) const { return durations_[phase]; }  ///< -1 if it is fixed
  int place(int stance) const { return places_[stance]; }      ///< -1 if it does not land

  int node_row(int k) const { return node_rows_[k]; }  ///< first row of node k
  /// Rows that link node k and node k + 1: the defects of an interval, or continuity at a phase switch.
  int link_row(int k) const { return first_link_row_ + 2 * nv_ * k; }
  int num_links() const { return num_nodes() - 1; }

 private:
  int nv_;
  int num_variables_ = 0, num_constraints_ = 0, first_link_row_ = 0;
  std::vector<int> nodes_;  ///< and the end of the last
  std::vector<int> node_rows_, durations_, places_;
};

}  // namespace prowl
