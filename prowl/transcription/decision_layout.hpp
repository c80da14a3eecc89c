#pragma once

#include <Eigen/Core>
#include <vector>

#include "prowl/transcription/mesh.hpp"

namespace prowl {

/// Where everything is in the decision variables z and in the constraints g: the only index arithmetic of the
/// transcription.
///
/// z: for each node of the mesh  (base position, rotation vector theta, joints | v | a | tau).
/// g: for each node  (dynamics c, nv rows | friction cone, one row an active contact),
///    for each interval  (defects of q, nv rows | defects of v, nv rows),
///    for each phase switch  (continuity of q, nv rows | of v, nv rows).
///
/// The base's rotation is R = R_chart exp(theta), with a chart of its own for each node (fixed by the initial guess or
/// by a boundary condition there), so that theta stays near zero and bounds on a goal's rotation are bounds on theta.
class DecisionLayout {
 public:
  DecisionLayout(const Mesh& mesh, int nv, std::vector<int> contacts_per_phase);

  int num_variables() const { return num_nodes_ * node_size(); }
  int num_constraints() const { return num_constraints_; }
  int num_nodes() const { return num_nodes_; }
  int node_size() const { return 3 * nv_ + nu(); }
  int nv() const { return nv_; }
  int nu() const { return nv_ - 6; }

  int node(int k) const { return k * node_size(); }  ///< first variable of node k
  int q(int k) const { return node(k); }
  int v(int k) const { return node(k) + nv_; }
  int a(int k) const { return node(k) + 2 * nv_; }
  int tau(int k) const { return node(k) + 3 * nv_; }

  int dynamics_row(int k) const { return node_rows_[static_cast<std::size_t>(k)]; }
  int friction_row(int k) const { return dynamics_row(k) + nv_; }
  int friction_count(int k) const { return friction_counts_[static_cast<std::size_t>(k)]; }

  /// Rows that link node k and node k + 1: the defects of an interval, or continuity at a phase switch.
  int link_row(int k) const { return first_link_row_ + 2 * nv_ * k; }
  int num_links() const { return num_nodes_ - 1; }

 private:
  int nv_;
  int num_nodes_;
  int first_link_row_ = 0;
  int num_constraints_ = 0;
  std::vector<int> node_rows_, friction_counts_;
};

}  // namespace prowl
