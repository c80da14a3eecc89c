#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "prowl/nlp/thread_team.hpp"
#include "prowl/transcription/interval_defects.hpp"
#include "prowl/transcription/motion_nlp.hpp"
#include "prowl/transcription/node_program.hpp"

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
  /// `guess` (one point a node) fixes the chart of the base's rotation at each node. `discrete` must outlive the
  /// program. Throws InputError if bounds contradict each other.
  Transcription(const DiscreteProblem& discrete, const Trajectory& guess);
  ~Transcription() override;

  Eigen::VectorXd pack(const Trajectory& trajectory) const override;
  Trajectory unpack(const Eigen::VectorXd& z) override;

  double cost(const Eigen::VectorXd& z) override;
  void cost_gradient(const Eigen::VectorXd& z, Eigen::Ref<Eigen::VectorXd> gradient) override;
  void constraints(const Eigen::VectorXd& z, Eigen::Ref<Eigen::VectorXd> g) override;
  void jacobian(const Eigen::VectorXd& z, Eigen::Ref<Eigen::VectorXd> values) override;
  void hessian(const Eigen::VectorXd& z, double cost_factor, const Eigen::VectorXd& multipliers,
               Eigen::Ref<Eigen::VectorXd> values) override;

  /// Variables, rows and functions node by node.
  const NodeProgram& nodes() const { return nodes_; }

  std::string describe_constraint(int row) const override;
  std::string describe_variable(int index) const override;

  int use_threads(int count) override;
  void use_hessian(HessianKind kind) override;
  StagewiseNlp* stagewise() override;

 private:
  void evaluate_all(const Eigen::VectorXd& z, bool with_derivatives) override;
  NodePoint node_point(const Eigen::VectorXd& z, int k) const;
  /// Of the interval after node k, and its derivative in the duration of the phase.
  double step(const Eigen::VectorXd& z, int k) const;
  double step_per_duration(int k) const;
  IntervalDefects interval(const Eigen::VectorXd& z, int k) const;
  IntervalEnd interval_end(const Eigen::VectorXd& z, int k) const;

  void set_shared_pairs();
  void set_rows();
  void set_patterns();
  template <class Emit>
  void visit_jacobian(const Eigen::VectorXd& z, Emit emit) const;
  template <class Emit>
  void visit_hessian(const std::vector<Eigen::MatrixXd>& nodes, const std::vector<Eigen::Matrix<double, 6, 6>>& links,
                     const Eigen::MatrixXd& shared, Emit emit) const;

  NodeProgram nodes_;
  const DecisionLayout& layout_;  ///< of nodes_
  std::vector<std::pair<int, int>>
      shared_pairs_;                ///< of shared variables (row >= column, from first_shared) in one phase
  std::vector<NodeValues> values_;  ///< one a node, where evaluate() was last
  ThreadTeam threads_{1};

  std::unique_ptr<StagewiseTranscription> stagewise_;  ///< made when first asked for
};

}  // namespace prowl
