#pragma once

#include <Eigen/Core>
#include <string>

#include "prowl/dynamics/rigid_body_terms.hpp"
#include "prowl/motion/motion_problem.hpp"
#include "prowl/trajectory/trajectory.hpp"

namespace prowl {

/// What joints and base have to give for a motion with the contact forces that are planned:
///
///   M(q) a + h(q, v) - sum J' f      [N, N m], n + 6 rows
///
/// The joint rows are torques. The base has no motor: its rows (base frame) are what the plan leaves out.
class InverseDynamics {
 public:
  explicit InverseDynamics(const RobotModel& robot);
  /// Of a point's q, v, a and forces.
  Eigen::VectorXd operator()(const TrajectoryPoint& point);

 private:
  RigidBodyTerms terms_;
  int num_contacts_;
};

/// A motion judged by inverse dynamics at its nodes, for programs to which torques are unknown.
struct InverseDynamicsCheck {
  double worst_torque = 0.0;  ///< of what the joint can give at its position and velocity [-]
  std::string worst_joint;
  double worst_torque_time = 0.0;  ///< [s]
  double worst_base_force = 0.0;   ///< left over on the base, of the weight [-]
  double worst_base_moment = 0.0;  ///< likewise, of weight times RobotModel::size() [-]
  double worst_base_time = 0.0;    ///< when the worse of the two is [s]
  double mean_base_force = 0.0;    ///< over the motion [-]
  double cost = 0.0;               ///< of the task, by the trapezoid, with a, f and these torques
};
InverseDynamicsCheck check_by_inverse_dynamics(const MotionProblem& problem, const Trajectory& motion);

}  // namespace prowl
