#pragma once

#include <Eigen/Core>

#include "prowl/dynamics/contact_kinematics.hpp"
#include "prowl/motion/motion_problem.hpp"
#include "prowl/transcription/node_point.hpp"

namespace prowl {

/// Cost of one node: its share of the running cost, and the terminal cost at the last node. Contact forces count as
/// variables of their own here; the caller knows how they follow from the others.
class NodeCost {
 public:
  explicit NodeCost(const MotionProblem& problem);

  /// `terms` at the configuration of the point; `forces` 3 per contact of the phase [N].
  double value(const NodePoint& point, const RigidBodyTerms& terms, const Eigen::VectorXd& forces);
  /// The running part of it.
  double running(const NodePoint& point, const RigidBodyTerms& terms, const Eigen::VectorXd& forces);

  struct Derivatives {
    Eigen::VectorXd gradient;          ///< in (tangent of q | v | a | tau)
    Eigen::VectorXd force_gradient;
    Eigen::MatrixXd hessian;           ///< in (tangent of q | v | a | tau), if asked for
    Eigen::VectorXd running_gradient;  ///< that part of `gradient`; all of force_gradient is running cost
  };
  void derivatives(const NodePoint& point, const RigidBodyTerms& terms, const Eigen::VectorXd& forces,
                   bool with_hessian, Derivatives& result);
  /// Second derivative of the cost in every force vector.
  Eigen::Vector3d force_curvature(const NodePoint& point) const { return point.cost_weight * running_.force_weight; }

 private:
  double state_cost(const QuadraticCost& cost, ContactKinematics& points, const NodePoint& point,
                    const RigidBodyTerms& terms);
  void add_state_cost(const QuadraticCost& cost, ContactKinematics& points, double weight, const NodePoint& point,
                      const RigidBodyTerms& terms, bool with_hessian, Derivatives& result);

  int nv_, nu_;
  QuadraticCost running_, terminal_;
  ContactKinematics running_points_, terminal_points_;  ///< contacts whose place costs something
};

}  // namespace prowl
