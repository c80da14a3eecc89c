#pragma once

#include <Eigen/Core>
#include <string>

#include "prowl/dynamics/contact_kinematics.hpp"
#include "prowl/dynamics/rigid_body_terms.hpp"
#include "prowl/motion/motion_problem.hpp"
#include "prowl/trajectory/trajectory.hpp"

namespace prowl {

/// Generalised forces required for a motion with its planned contact forces:
///
///   M(q) a + h(q, v) - sum J' f      [N, N m], n + 6 rows
///
/// The joint rows are torques. The base is not actuated: its rows (base frame) are the residual of
/// the plan.
class InverseDynamics {
 public:
  explicit InverseDynamics(const RobotModel& robot);
  /// Uses q, v, a and forces of the point.
  Eigen::VectorXd operator()(const TrajectoryPoint& point);

 private:
  RigidBodyTerms terms_;
  ContactKinematics contacts_;
};

/// Inverse dynamics at the nodes of a motion, for programs without torques.
struct InverseDynamicsCheck {
  double worst_torque = 0.0;  ///< share of the limit at the joint position and velocity [-]
  std::string worst_joint;
  double worst_torque_time = 0.0;  ///< [s]
  double worst_base_force = 0.0;   ///< residual on the base, over the weight [-]
  double worst_base_moment = 0.0;  ///< likewise, over weight times RobotModel::size() [-]
  double worst_base_time = 0.0;    ///< time of the worse of the two [s]
  double mean_base_force = 0.0;    ///< time average [-]
  double cost = 0.0;               ///< of the task, by the trapezoid, with a, f and these torques
};
InverseDynamicsCheck check_by_inverse_dynamics(const MotionProblem& problem, const Trajectory& motion);

}  // namespace prowl
