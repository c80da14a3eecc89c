#pragma once

#include <Eigen/Core>

#include "prowl/dynamics/contact_kinematics.hpp"
#include "prowl/motion/motion_problem.hpp"
#include "prowl/transcription/node/node_point.hpp"

namespace prowl {

/// Cost of one node: its share of the running cost, and the terminal cost at the last node. Contact
/// forces are independent variables here; the caller applies the chain rule.
class NodeCost {
 public:
  explicit NodeCost(const MotionProblem& problem);

  /// Replaces q_ref (nq) and v_ref (nv) of both costs.
  void refer_to(const Eigen::VectorXd& q_ref, const Eigen::VectorXd& v_ref);

  /// `terms`: at the configuration of the point; `forces`: 3 per contact of the phase, world frame
  /// [N].
  double value(const NodePoint& point, const RigidBodyTerms& terms, const Eigen::VectorXd& forces);
  /// After value(): its running part.
  double running() const { return running_value_; }

  struct Derivatives {
    Eigen::VectorXd gradient;  ///< in (tangent of q | v | a | tau)
    Eigen::VectorXd force_gradient;
    Eigen::VectorXd running_gradient;  ///< running part of `gradient`; force_gradient is all running cost
  };
  /// After value() at the same point.
  void derivatives(const NodePoint& point, const Eigen::VectorXd& forces, Derivatives& result);
  /// After derivatives(): adds factor times the block-diagonal Hessian in (tangent of q | v | a |
  /// tau) at fixed forces to the first rows and columns of the result.
  void add_hessian(const NodePoint& point, double factor, Eigen::MatrixXd& result);
  /// Second derivative of the cost in each force, diagonal.
  Eigen::Vector3d force_curvature(const NodePoint& point) const {
    return point.cost_weight * running_.cost.force_weight;
  }

 private:
  /// Running or terminal cost of a state, with work space.
  struct StateCost {
    explicit StateCost(const QuadraticCost& quadratic);
    double value(const NodePoint& point, const RigidBodyTerms& terms);
    void add_gradient(double weight, const NodePoint& point, Eigen::VectorXd& gradient);
    void add_hessian(double weight, Eigen::MatrixXd& result);

    QuadraticCost cost;
    ContactKinematics points;  ///< contacts with a position cost
    ConfigurationCost configuration;
    Eigen::VectorXd velocity;         ///< v - v_ref
    Eigen::VectorXd stiffness, pull;  ///< of their positions
    Eigen::MatrixXd stiff_points;
  };

  int nv_, nu_;
  StateCost running_, terminal_;
  double running_value_ = 0.0;
};

}  // namespace prowl
