#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "prowl/error.hpp"
#include "prowl/mesh/discrete_problem.hpp"
#include "prowl/nlp/thread_team.hpp"
#include "prowl/trajectory/trajectory.hpp"
#include "prowl/transcription/decision_layout.hpp"
#include "prowl/transcription/node/node_functions.hpp"
#include "prowl/transcription/transcription_bounds.hpp"

namespace prowl {

/// A motion problem by the trapezoid, node by node: the decision variables of each node, what holds there and their
/// bounds. Two programs read it: Transcription, with all variables in one vector, and StagewiseTranscription, as a
/// chain of stages.
///
/// Derivatives at a node are in its own variables, followed by those that the nodes of its phase share (NodeFunctions);
/// column() tells which decision variable each is.
class NodeProgram {
 public:
  /// `guess` (one point a node) fixes the chart of the base's rotation at each node. `discrete` must outlive the
  /// program. Throws InputError if bounds contradict each other.
  NodeProgram(const DiscreteProblem& discrete, const Trajectory& guess);
  NodeProgram(const NodeProgram&) = delete;
  NodeProgram& operator=(const NodeProgram&) = delete;

  const DiscreteProblem& discrete() const { return discrete_; }
  const DecisionLayout& layout() const { return layout_; }
  const VariableBounds& bounds() const { return bounds_; }
  int num_nodes() const { return layout_.num_nodes(); }
  int phase_of(int k) const { return discrete_.nodes[k].phase; }
  const Eigen::Matrix3d& chart(int k) const { return charts_[k]; }

  const NodeFunctions& functions(int k) const { return functions_.front()[phase_of(k)]; }
  /// Those of the calling thread.
  NodeFunctions& functions(int k) { return functions_[ThreadTeam::slot()][phase_of(k)]; }
  int num_rows(int k) const { return functions(k).num_rows(discrete_.nodes[k].node); }

  /// Decision variables that the nodes of a phase share.
  const std::vector<int>& shared(int phase) const { return shared_[phase]; }
  /// Decision variable of column j of node k's derivatives.
  int column(int k, int j) const;
  /// Those of node k out of all decision variables, in the order of column().
  Eigen::VectorXd variables(int k, const Eigen::VectorXd& z) const;
  /// The instant that such variables of node k mean; into what is there, without allocation if it has the sizes
  /// already.
  void set_point(int k, const Eigen::VectorXd& variables, NodePoint& point) const;

  /// Evaluates something at node k; a NumericalError then says where.
  template <class Evaluate>
  void at_node(int k, const Evaluate& evaluate) const {
    try {
      evaluate();
    } catch (const NumericalError& error) {
      throw NumericalError(discrete_.describe_moment(k) + ": " + error.what());
    }
  }

  void use_threads(int count);  ///< node functions for so many; see Nlp
  void use_hessian(HessianKind kind);
  HessianKind hessian_kind() const { return functions_.front().front().hessian_kind(); }

 private:
  std::vector<NodeFunctions> functions_of_phases() const;

  const DiscreteProblem& discrete_;
  std::vector<PhaseContacts> contacts_;                ///< of each phase
  std::vector<std::vector<NodeFunctions>> functions_;  ///< what holds at a node: for each thread, one a phase
  std::vector<Eigen::VectorXd> anchor_origins_;        ///< anchors of each phase's contacts where the places are zero
  DecisionLayout layout_;
  VariableBounds bounds_;
  std::vector<Eigen::Matrix3d> charts_;   ///< one a node
  std::vector<std::vector<int>> shared_;  ///< of each phase
};

}  // namespace prowl
