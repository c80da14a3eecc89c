#pragma once

#include <Eigen/Core>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "alternatives/centroidal/centroidal_interval.hpp"
#include "alternatives/centroidal/centroidal_layout.hpp"
#include "alternatives/centroidal/centroidal_node.hpp"
#include "alternatives/formulation.hpp"
#include "prowl/transcription/motion_nlp.hpp"

namespace prowl {

/// Centroidal dynamics with full kinematics: a motion problem in which contact forces move the centre of mass and turn
/// the robot, and q only follows. Dai, Valenzuela, Tedrake, "Whole-body motion planning with centroidal dynamics and
/// full kinematics", Humanoids 2014, sec. II-D, with the contacts of each phase known.
///
/// Variables of a node: q, v | centre of mass r, r', r'' | angular momentum h about it, h' | for each contact its
/// position c and its force f. Rows: CentroidalNode, CentroidalInterval. Joint torques are unknown to it: limits and
/// costs on them do not count, the rest of the task does. The running cost is the sum over the intervals of step times
/// cost at their end; of accelerations, r'' stands for the base's linear one, and differences of v for all others.
class CentroidalNlp : public MotionNlp {
 public:
  /// `guess` (one point a node) fixes the chart of the base's rotation at each node. Throws InputError if bounds
  /// contradict each other, or if the task asks for torques.
  CentroidalNlp(const DiscreteProblem& discrete, const Trajectory& guess);

  Eigen::VectorXd pack(const Trajectory& trajectory) const override;
  /// a is the program's own rate of v, (v_k - v_k-1) / dt, constant over an interval as forces are; tau what inverse
  /// dynamics make of it with the planned forces. What these leave on the base: InverseDynamics.
  Trajectory unpack(const Eigen::VectorXd& z) override;

  double cost(const Eigen::VectorXd& z) override;
  void cost_gradient(const Eigen::VectorXd& z, Eigen::Ref<Eigen::VectorXd> gradient) override;
  void constraints(const Eigen::VectorXd& z, Eigen::Ref<Eigen::VectorXd> g) override;
  void jacobian(const Eigen::VectorXd& z, Eigen::Ref<Eigen::VectorXd> values) override;
  void hessian(const Eigen::VectorXd& z, double cost_factor, const Eigen::VectorXd& multipliers,
               Eigen::Ref<Eigen::VectorXd> values) override;

  std::string describe_constraint(int row) const override;
  std::string describe_variable(int index) const override;
  void use_hessian(HessianKind kind) override { hessian_kind_ = kind; }

  /// Row by row what node k adds to the program: its variables; its rows and those of the interval (or phase switch)
  /// that ends in it. Durations of phases, which nodes share, are not among them.
  std::vector<RowGroup> variable_groups(int k) const;
  std::vector<RowGroup> constraint_groups(int k) const;

 private:
  const CentroidalNode& node(int k) const { return phases_[phase_of(k)]; }
  CentroidalNode& node(int k) { return phases_[phase_of(k)]; }
  double share(int k) const;  ///< of the duration of node k's phase that a step is
  double step(const Eigen::VectorXd& z, int k) const;
  CentroidalPoint point(const Eigen::VectorXd& z, int k) const;
  CentroidalInterval interval(const Eigen::VectorXd& z, int k) const;
  void evaluate_all(const Eigen::VectorXd& z, bool with_derivatives) override;
  void fill_jacobian(const Eigen::VectorXd& z);

  void set_bounds();
  void set_patterns(const Trajectory& guess);
  struct HessianBlocks {
    std::vector<Eigen::MatrixXd> nodes;                ///< of each node, in its variables and the duration
    std::vector<CentroidalInterval::Between> between;  ///< of each link
    Eigen::VectorXd durations;                         ///< of each phase, by itself
  };
  /// Calls emit(row, col, value) for each place of the Hessian, always in the same order.
  template <class Emit>
  void visit_hessian(const HessianBlocks& blocks, Emit emit) const;

  CentroidalScale scale_;
  std::deque<CentroidalNode> phases_;
  CentroidalLayout layout_;
  std::vector<Eigen::Matrix3d> charts_;  ///< one a node
  Eigen::VectorXd acceleration_weight_;  ///< but for the base's linear one
  HessianKind hessian_kind_ = HessianKind::exact;
  /// Of each node's Hessian: lower triangle, with the duration as the last variable.
  std::vector<std::vector<std::pair<int, int>>> node_places_;

  std::vector<CentroidalValues> values_;  ///< one a node, where evaluate() was last
  SparseEntries jacobian_;
};

/// As make_formulation(). Rules of integration, contact and orientation are its own: throws InputError if another one
/// than the default of the other dynamics is asked for.
std::unique_ptr<MotionNlp> make_centroidal(const Formulation& formulation, const DiscreteProblem& discrete,
                                           const Trajectory& guess);

}  // namespace prowl
