#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "prowl/motion/motion_problem.hpp"
#include "prowl/nlp/nlp.hpp"
#include "prowl/trajectory/trajectory.hpp"
#include "prowl/transcription/decision_layout.hpp"
#include "prowl/transcription/mesh.hpp"
#include "prowl/transcription/node_functions.hpp"

namespace prowl {

/// Direct transcription by the trapezoid: a motion problem as a nonlinear program.
///
/// At every node the projected dynamics c(q, v, a, tau) = 0 and the friction cones of the recovered forces hold; over
/// every interval q and v follow the trapezoid of v and a; all else (joint, velocity and torque limits, start, goals)
/// are bounds on the decision variables. Cost: the running cost by the trapezoid, and the terminal cost.
/// Betts, Practical Methods for Optimal Control, 2010, sec. 4.5; docs/transcription.md.
///
/// Needs fixed durations, independent contacts, and no contact that closes after the start.
class Transcription : public Nlp {
 public:
  /// `guess` (one point a node) fixes the chart of the base's rotation at each node. Throws InputError if the problem
  /// is outside what the transcription can do.
  Transcription(const MotionProblem& problem, const Mesh& mesh, const Trajectory& guess);

  Eigen::VectorXd pack(const Trajectory& trajectory) const;
  /// Includes the contact forces. Throws NumericalError if z is not finite.
  Trajectory unpack(const Eigen::VectorXd& z);

  int num_variables() const override { return layout_.num_variables(); }
  int num_constraints() const override { return layout_.num_constraints(); }
  const Eigen::VectorXd& variable_lower() const override { return variable_lower_; }
  const Eigen::VectorXd& variable_upper() const override { return variable_upper_; }
  const Eigen::VectorXd& constraint_lower() const override { return constraint_lower_; }
  const Eigen::VectorXd& constraint_upper() const override { return constraint_upper_; }
  const SparsityPattern& jacobian_pattern() const override { return jacobian_pattern_; }
  const SparsityPattern& hessian_pattern() const override { return hessian_pattern_; }

  double cost(const Eigen::VectorXd& z) override;
  void cost_gradient(const Eigen::VectorXd& z, Eigen::Ref<Eigen::VectorXd> gradient) override;
  void constraints(const Eigen::VectorXd& z, Eigen::Ref<Eigen::VectorXd> g) override;
  void jacobian(const Eigen::VectorXd& z, Eigen::Ref<Eigen::VectorXd> values) override;
  void hessian(const Eigen::VectorXd& z, double cost_factor, const Eigen::VectorXd& multipliers,
               Eigen::Ref<Eigen::VectorXd> values) override;

  std::string describe_constraint(int row) const override;
  std::string describe_variable(int index) const override;

 private:
  void set_patterns();
  template <class Emit>
  void visit_jacobian(const Eigen::VectorXd& z, Emit emit) const;
  template <class Emit>
  void visit_hessian(const std::vector<Eigen::MatrixXd>& nodes, const std::vector<Eigen::Matrix<double, 6, 6>>& links,
                     Emit emit) const;
  void add_defect_hessian(const Eigen::VectorXd& z, const Eigen::VectorXd& multipliers, int k,
                          std::vector<Eigen::MatrixXd>& nodes, Eigen::Matrix<double, 6, 6>& link) const;
  std::string describe_node(int k) const;
  NodePoint node_point(const Eigen::VectorXd& z, int k) const;
  bool is_interval(int k) const;  ///< between nodes k and k + 1; else a phase switch
  double step(int k) const { return mesh_.nodes[static_cast<std::size_t>(k)].h_out; }
  void evaluate_nodes(const Eigen::VectorXd& z, bool with_derivatives);

  MotionProblem problem_;
  Mesh mesh_;
  DecisionLayout layout_;
  std::vector<Eigen::Matrix3d> charts_;  ///< one a node
  std::vector<NodeFunctions> phases_;    ///< what holds at a node, one a phase
  Eigen::VectorXd variable_lower_, variable_upper_, constraint_lower_, constraint_upper_;
  SparsityPattern jacobian_pattern_, hessian_pattern_;

  // What was evaluated last, and where.
  Eigen::VectorXd evaluated_at_;
  bool have_derivatives_ = false;
  std::vector<NodeValues> values_;
};

}  // namespace prowl
