#pragma once

#include <Eigen/Core>
#include <vector>

#include "prowl/dynamics/projected_residual.hpp"
#include "prowl/motion/friction_cone.hpp"
#include "prowl/motion/motion_problem.hpp"

namespace prowl {

/// The decision variables of one node, in their own chart: R = chart exp(theta).
struct NodePoint {
  Eigen::VectorXd q, v, a, tau;
  Eigen::Vector3d theta;
  double cost_weight = 0.0;      ///< of the running cost: the node's share of the time [s]
  double terminal_weight = 0.0;  ///< of the terminal cost: 1 at the last node
};

/// What is evaluated at one node: rows are (scaled dynamics, nv | scaled friction cones).
struct NodeValues {
  double cost = 0.0;
  Eigen::VectorXd rows;
  Eigen::VectorXd forces;            ///< 3 per contact of the phase, world frame [N]
  Eigen::VectorXd cost_gradient;     ///< in the variables of the node
  Eigen::MatrixXd rows_jacobian;     ///< rows x variables of the node
};

/// Everything that holds at a node of one phase: the dynamics, the friction cones, the cost, with exact first and second
/// derivatives in the variables of the node (base position, theta, joints | v | a | tau).
///
/// Rows are scaled by the size of the robot, so that one tolerance means the same for 2.5 kg and for 80 kg: forces by its
/// weight, moments by its weight times its standing height.
class NodeFunctions {
 public:
  /// `anchors`: place of each contact of the phase, 3 rows each, world frame [m]. `step`: of the phase's mesh [s].
  NodeFunctions(const MotionProblem& problem, const Phase& phase, const Eigen::VectorXd& anchors, double step);

  int num_rows() const { return nv_ + static_cast<int>(cones_.size()); }
  int num_variables() const { return 3 * nv_ + nu_; }
  const std::vector<int>& contacts() const { return dynamics_.contacts(); }
  bool contacts_are_independent() const { return dynamics_.has_full_rank(); }  ///< at the last evaluation

  void evaluate(const NodePoint& point, NodeValues& values);
  void evaluate_with_derivatives(const NodePoint& point, NodeValues& values);
  /// Hessian of cost_factor * cost + multipliers . rows, all of the node's variables, symmetric.
  void hessian(const NodePoint& point, double cost_factor, const Eigen::VectorXd& multipliers, Eigen::MatrixXd& result);

 private:
  DynamicsPoint dynamics_point(const NodePoint& point) const;
  double cost(const NodePoint& point);
  /// Cost gradient and Hessian in (tangent of q | v | a | tau), forces taken as variables of their own.
  void cost_derivatives(const NodePoint& point, Eigen::VectorXd& gradient, Eigen::VectorXd& force_gradient,
                        Eigen::MatrixXd* hessian);
  void fill_rows(NodeValues& values) const;

  int nv_, nu_;
  QuadraticCost running_, terminal_;
  std::vector<FrictionCone> cones_;
  Eigen::VectorXd anchors_;
  ContactStabilisation stabilisation_;
  ProjectedResidual dynamics_;
  ContactKinematics running_points_, terminal_points_;  ///< contacts whose place costs something
  Eigen::VectorXd row_scale_;                           ///< num_rows()
};

}  // namespace prowl
