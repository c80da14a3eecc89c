#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "prowl/error.hpp"
#include "prowl/mesh/discrete_problem.hpp"
#include "prowl/nlp/thread_team.hpp"
#include "prowl/trajectory/trajectory.hpp"
#include "prowl/transcription/decision_layout.hpp"
#include "prowl/transcription/deferred_correction.hpp"
#include "prowl/transcription/node/node_functions.hpp"
#include "prowl/transcription/transcription_bounds.hpp"

namespace prowl {

/// A motion problem transcribed by the trapezoid, node by node: variables, bounds and functions of
/// each node. Two programs read it: Transcription (all variables in one vector) and
/// StagewiseTranscription (chain of stages).
///
/// Derivatives at a node are in its own variables, then in those shared by its phase
/// (NodeFunctions); column() maps them to decision variables.
class NodeProgram {
 public:
  /// `guess` (one point per node) fixes the chart of the base rotation at each node. `discrete`
  /// must outlive the program. Throws InputError for contradictory bounds.
  NodeProgram(const DiscreteProblem& discrete, const Trajectory& guess, Corrections corrections = {});
  NodeProgram(const NodeProgram&) = delete;
  NodeProgram& operator=(const NodeProgram&) = delete;

  const DiscreteProblem& discrete() const { return discrete_; }
  const DecisionLayout& layout() const { return layout_; }
  const VariableBounds& bounds() const { return bounds_; }
  int num_nodes() const { return layout_.num_nodes(); }
  int phase_of(int k) const { return discrete_.nodes[k].phase; }
  const Eigen::Matrix3d& chart(int k) const { return charts_[k]; }
  /// Of the interval that ends at node k (2 nv); zero if there are none.
  const Eigen::VectorXd& correction(int k) const {
    return is_corrected() && corrections_[k].size() > 0 ? corrections_[k] : none_;
  }
  bool is_corrected() const { return !corrections_.empty(); }

  const NodeFunctions& functions(int k) const { return functions_.front()[phase_of(k)]; }
  /// Functions of node k for the calling thread.
  NodeFunctions& functions(int k) { return functions_[ThreadTeam::slot()][phase_of(k)]; }
  int num_rows(int k) const { return functions(k).num_rows(discrete_.nodes[k].node); }

  /// Indices of the decision variables shared by the nodes of a phase.
  const std::vector<int>& shared(int phase) const { return shared_[phase]; }
  /// Index of the decision variable of column j of node k's derivatives.
  int column(int k, int j) const;
  /// Variables of node k, in the order of column().
  Eigen::VectorXd variables(int k, const Eigen::VectorXd& z) const;
  /// Sets `point` from the variables of node k; does not allocate if it has the right sizes.
  void set_point(int k, const Eigen::VectorXd& variables, NodePoint& point) const;

  /// Calls evaluate() and adds the location of node k to a NumericalError.
  template <class Evaluate>
  void at_node(int k, const Evaluate& evaluate) const {
    try {
      evaluate();
    } catch (const NumericalError& error) {
      throw NumericalError(discrete_.describe_moment(k) + ": " + error.what());
    }
  }

  void use_threads(int count);  ///< prepares node functions for `count` threads; see Nlp
  void use_hessian(HessianKind kind);
  HessianKind hessian_kind() const { return functions_.front().front().hessian_kind(); }

 private:
  std::vector<NodeFunctions> functions_of_phases() const;

  const DiscreteProblem& discrete_;
  std::vector<PhaseContacts> contacts_;                ///< per phase
  std::vector<std::vector<NodeFunctions>> functions_;  ///< per thread and phase
  std::vector<Eigen::VectorXd> anchor_origins_;        ///< per phase: anchors at zero foothold coordinates
  DecisionLayout layout_;
  VariableBounds bounds_;
  std::vector<Eigen::Matrix3d> charts_;   ///< per node
  Corrections corrections_;               ///< per node
  Eigen::VectorXd none_;                  ///< zero
  std::vector<std::vector<int>> shared_;  ///< per phase
};

}  // namespace prowl
