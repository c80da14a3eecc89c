#pragma once

#include "alternatives/collocation/charts/base_chart.hpp"
#include "alternatives/collocation/contact_rows.hpp"
#include "prowl/transcription/node/node_functions.hpp"

namespace prowl {

/// Instant of evaluation within a phase.
struct Instant {
  int node = 0;                  ///< index in the phase, as in NodeFunctions
  double cost_share = 0.0;       ///< quadrature weight of the running cost over the step h
  double terminal_weight = 0.0;  ///< 1 at the last node of the motion
};

/// NodeFunctions and ContactRows of one phase in coordinates x = (base position, e, joints) of a chart:
///
///   columns   x | v | a | tau | w | shared (duration, if free | two coordinates per free foothold)
///   rows      those of NodeFunctions | those of ContactRows
///
/// v contains the base twist; a is its rate. Not thread-safe: shared work space.
class ChartedNode {
 public:
  ChartedNode(const DiscreteProblem& discrete, int phase, const PhaseContacts& contacts,
              const StabilisationOfStep& stabilisation, const ContactRows& contact_rows, const BaseChart& chart,
              Eigen::VectorXd anchor_origin);

  const NodeFunctions& functions() const { return functions_; }
  const ContactRows& contact_rows() const { return contact_rows_; }
  const BaseChart& chart() const { return chart_; }
  int num_columns() const { return functions_.num_columns(); }
  int num_dofs() const { return robot().nv(); }
  int num_rows(int node) const { return functions_.num_rows(node) + contact_rows_.count(); }
  double lower(int node, int row) const;
  double upper(int node, int row) const;
  std::string describe_row(int node, int row) const;
  std::string describe_coordinate(int i) const;  ///< of x or v

  struct Values {
    double cost = 0.0;
    Eigen::VectorXd rows;
    Eigen::VectorXd forces;  ///< 3 per contact of the phase, world frame [N]
    Eigen::VectorXd cost_gradient;
    Eigen::MatrixXd rows_jacobian;
  };
  void evaluate(const Instant& at, const Eigen::VectorXd& columns, Values& values);
  void evaluate_with_derivatives(const Instant& at, const Eigen::VectorXd& columns, Values& values);
  /// Hessian of cost_factor cost + multipliers . rows, in all columns, symmetric.
  void hessian(const Instant& at, const Eigen::VectorXd& columns, double cost_factor,
               const Eigen::VectorXd& multipliers, Eigen::MatrixXd& result);
  void use_hessian(HessianKind kind) { functions_.use_hessian(kind); }

  /// Configuration (nq) of these columns.
  Eigen::VectorXd configuration(const Eigen::VectorXd& columns) const;
  double duration(const Eigen::VectorXd& columns) const;  ///< [s]

 private:
  NodePoint point(const Instant& at, const Eigen::VectorXd& columns) const;
  void gather(const ContactRows::Derivatives& derivatives, const NodePoint& where,
              Eigen::Ref<Eigen::MatrixXd> rows) const;
  void add_contact_hessian(const NodePoint& point, const Eigen::VectorXd& multipliers, Eigen::MatrixXd& result);

  const Phase& phase() const { return discrete_.problem.phases[phase_]; }
  const RobotModel& robot() const { return discrete_.problem.robot; }
  int first_foothold_variable() const { return functions_.num_variables() + (functions_.has_free_duration() ? 1 : 0); }

  const DiscreteProblem& discrete_;
  int phase_;
  const BaseChart& chart_;
  Eigen::VectorXd anchor_origin_;
  NodeFunctions functions_;
  ContactRows contact_rows_;
  NodeValues inner_;
  ContactRows::Derivatives contact_derivatives_;
};

}  // namespace prowl
