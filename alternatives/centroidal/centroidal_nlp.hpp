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

/// Centroidal dynamics with full kinematics: contact forces drive the centre of mass and the
/// angular momentum; q follows kinematically. Dai, Valenzuela, Tedrake, "Whole-body motion planning
/// with centroidal dynamics and full kinematics", Humanoids 2014, sec. II-D, with the contacts of
/// each phase known.
///
/// Variables of a node: q, v | centre of mass r, r', r'' | angular momentum h about it, h' | for
/// each contact its position c and its force f. Rows: CentroidalNode, CentroidalInterval. It
/// contains no joint torques and ignores their limits and costs. The running cost is the sum over
/// the intervals of step times cost at their end. In the cost of accelerations r'' replaces the
/// base's linear one, differences of v all others.
class CentroidalNlp : public MotionNlp {
 public:
  /// `guess` (one point per node) fixes the chart of the base rotation at each node. Throws
  /// InputError for contradictory bounds, or goals with torques.
  CentroidalNlp(const DiscreteProblem& discrete, const Trajectory& guess);

  Eigen::VectorXd pack(const Trajectory& trajectory) const override;
  /// a = (v_k - v_k-1) / dt is constant over an interval, like the forces; tau follows from inverse
  /// dynamics with the planned forces. Residual on the base: see InverseDynamics.
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

  /// Contribution of node k to the program: its variables; its rows and those of the interval (or
  /// phase transition) that ends at it. Excludes the shared durations of phases.
  std::vector<RowGroup> variable_groups(int k) const;
  std::vector<RowGroup> constraint_groups(int k) const;

 private:
  const CentroidalNode& node(int k) const { return phases_[phase_of(k)]; }
  CentroidalNode& node(int k) { return phases_[phase_of(k)]; }
  double share(int k) const;  ///< step over the duration of node k's phase
  double step(const Eigen::VectorXd& z, int k) const;
  CentroidalPoint point(const Eigen::VectorXd& z, int k) const;
  CentroidalInterval interval(const Eigen::VectorXd& z, int k) const;
  void evaluate_all(const Eigen::VectorXd& z, bool with_derivatives) override;
  void fill_jacobian(const Eigen::VectorXd& z);

  void set_bounds();
  void set_patterns(const Trajectory& guess);
  struct HessianBlocks {
    std::vector<Eigen::MatrixXd> nodes;                ///< per node, in its variables and the duration
    std::vector<CentroidalInterval::Between> between;  ///< per link
    Eigen::VectorXd durations;                         ///< per phase
  };
  /// Calls emit(row, col, value) for each entry of the Hessian, in a fixed order.
  template <class Emit>
  void visit_hessian(const HessianBlocks& blocks, Emit emit) const;

  CentroidalScale scale_;
  std::deque<CentroidalNode> phases_;
  CentroidalLayout layout_;
  std::vector<Eigen::Matrix3d> charts_;  ///< per node
  Eigen::VectorXd acceleration_weight_;  ///< all but the base's linear one
  HessianKind hessian_kind_ = HessianKind::exact;
  /// Lower-triangle entries of each node's Hessian, duration last.
  std::vector<std::vector<std::pair<int, int>>> node_entries_;

  std::vector<CentroidalValues> values_;  ///< per node, of the last evaluate()
  SparseEntries jacobian_;
};

/// Like make_formulation(). Integration rule, contact form and orientation are its own: throws
/// InputError unless they have the defaults of the other dynamics.
std::unique_ptr<MotionNlp> make_centroidal(const Formulation& formulation, const DiscreteProblem& discrete,
                                           const Trajectory& guess);

}  // namespace prowl
