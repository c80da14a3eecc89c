#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "prowl/error.hpp"
#include "prowl/motion/contact_schedule.hpp"
#include "prowl/motion/motion_problem.hpp"
#include "prowl/nlp/thread_team.hpp"
#include "prowl/trajectory/trajectory.hpp"
#include "prowl/transcription/decision_layout.hpp"
#include "prowl/transcription/interval_defects.hpp"
#include "prowl/transcription/mesh.hpp"
#include "prowl/transcription/motion_nlp.hpp"
#include "prowl/transcription/node_functions.hpp"

namespace prowl {

class StagewiseTranscription;

/// Direct transcription by the trapezoid: a motion problem as a nonlinear program.
///
/// At every node the projected dynamics c(q, v, a, tau) = 0, the friction cones of the recovered forces and what else
/// NodeFunctions lists hold; over every interval q and v follow the trapezoid of v and a; all else (joint, velocity and
/// torque limits, start, goals, durations, places of contacts) are bounds on the decision variables. Cost: the running
/// cost by the trapezoid, and the terminal cost.
/// Betts, Practical Methods for Optimal Control, 2010, sec. 4.5; docs/transcription.md.
class Transcription : public MotionNlp {
 public:
  /// `guess` (one point a node) fixes the chart of the base's rotation at each node. Throws InputError if bounds
  /// contradict each other.
  Transcription(const MotionProblem& problem, const Mesh& mesh, const Trajectory& guess);
  Transcription(const Transcription&) = delete;  // stagewise() refers to it
  Transcription& operator=(const Transcription&) = delete;
  ~Transcription() override;

  Eigen::VectorXd pack(const Trajectory& trajectory) const override;
  Trajectory unpack(const Eigen::VectorXd& z) override;

  double cost(const Eigen::VectorXd& z) override;
  void cost_gradient(const Eigen::VectorXd& z, Eigen::Ref<Eigen::VectorXd> gradient) override;
  void constraints(const Eigen::VectorXd& z, Eigen::Ref<Eigen::VectorXd> g) override;
  void jacobian(const Eigen::VectorXd& z, Eigen::Ref<Eigen::VectorXd> values) override;
  void hessian(const Eigen::VectorXd& z, double cost_factor, const Eigen::VectorXd& multipliers,
               Eigen::Ref<Eigen::VectorXd> values) override;

  /// All that a task might have otherwise, but for durations: friction, torques, positions and velocities of joints,
  /// goals, places and clearance. The start is none, and no bound that is not there.
  std::vector<MotionLimit> limits() const;

  std::string describe_constraint(int row) const override;
  std::string describe_variable(int index) const override;

  int use_threads(int count) override;
  void use_hessian(HessianKind kind) override;
  StagewiseNlp* stagewise() override;

 private:
  friend class StagewiseTranscription;  // another form of the same nodes
  const MeshNode& mesh_node(int k) const { return mesh_.nodes[k]; }
  int phase_of(int k) const { return mesh_node(k).phase; }
  const NodeFunctions& functions(int k) const { return phases_.front()[phase_of(k)]; }
  /// Those of the calling thread.
  NodeFunctions& functions(int k) { return phases_[ThreadTeam::slot()][phase_of(k)]; }
  /// Whether nodes k and k + 1 are the ends of an interval; else they are a phase switch.
  bool is_interval(int k) const { return mesh_node(k).h_out > 0.0; }
  double duration(const Eigen::VectorXd& z, int phase) const;
  /// Of the interval after node k, and its derivative in the duration of the phase.
  double step(const Eigen::VectorXd& z, int k) const;
  double step_per_duration(int k) const;
  NodePoint node_point(const Eigen::VectorXd& z, int k) const;
  /// The same from the variables of the node and those that its phase shares, in the order of column().
  void set_point(int k, const Eigen::VectorXd& node, NodePoint& point) const;
  IntervalDefects interval(const Eigen::VectorXd& z, int k) const;
  IntervalEnd interval_end(const Eigen::VectorXd& z, int k) const;
  void evaluate_nodes(const Eigen::VectorXd& z, bool with_derivatives);

  /// Decision variable of column j of node k's derivatives.
  int column(int k, int j) const;
  void set_patterns();
  template <class Emit>
  void visit_jacobian(const Eigen::VectorXd& z, Emit emit) const;
  template <class Emit>
  void visit_hessian(const std::vector<Eigen::MatrixXd>& nodes, const std::vector<Eigen::Matrix<double, 6, 6>>& links,
                     const Eigen::MatrixXd& shared, Emit emit) const;
  std::string describe_node(int k) const;
  std::string describe_place(int k) const;  ///< the node with its time
  /// Evaluates something at node k; a NumericalError then says where.
  template <class Evaluate>
  void at_node(int k, const Evaluate& evaluate) const {
    try {
      evaluate();
    } catch (const NumericalError& error) {
      throw NumericalError(describe_place(k) + ": " + error.what());
    }
  }
  std::string describe_shared(int index) const;

  MotionProblem problem_;
  ContactSchedule schedule_;
  Mesh mesh_;
  std::vector<PhaseContacts> contacts_;             ///< of each phase
  std::vector<std::vector<NodeFunctions>> phases_;  ///< what holds at a node: for each thread, one a phase
  std::vector<std::vector<int>> shared_;            ///< decision variables that the nodes of a phase share
  std::vector<Eigen::VectorXd> anchor_origins_;     ///< anchors of each phase's contacts where the places are zero
  DecisionLayout layout_;
  std::vector<Eigen::Matrix3d> charts_;  ///< one a node
  std::vector<std::pair<int, int>>
      shared_pairs_;  ///< of shared variables (row >= column, from first_shared) in one phase

  // What was evaluated last, and where.
  Eigen::VectorXd evaluated_at_;
  bool have_derivatives_ = false;
  std::vector<NodeValues> values_;
  ThreadTeam threads_{1};

  std::unique_ptr<StagewiseTranscription> stagewise_;  ///< made when first asked for
};

}  // namespace prowl
