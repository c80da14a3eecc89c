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
/// Rows at every node: projected dynamics c(q, v, a, tau) = 0, friction cones and the other rows of
/// NodeFunctions. Rows of every interval: q and v follow the trapezoid of v and a. Joint, velocity
/// and torque limits, start, goals, durations and footholds are bounds on the decision variables.
/// Cost: running cost by the trapezoid, plus terminal cost. Betts, Practical Methods for Optimal
/// Control, 2010, sec. 4.5; docs/transcription.md.
class Transcription : public MotionNlp {
 public:
  /// `guess` (one point per node) fixes the chart of the base rotation at each node. `discrete`
  /// must outlive the program. Throws InputError for contradictory bounds.
  Transcription(const DiscreteProblem& discrete, const Trajectory& guess, Corrections corrections = {});
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
  /// Step of the interval after node k [s], and its derivative in the duration of the phase.
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
      shared_pairs_;                ///< of shared variables of one phase (row >= column, from first_shared)
  std::vector<NodeValues> values_;  ///< per node, of the last evaluate()
  ThreadTeam threads_{1};

  std::unique_ptr<StagewiseTranscription> stagewise_;  ///< created on demand
};

}  // namespace prowl
