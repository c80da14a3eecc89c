#pragma once

#include <mutex>

#include "prowl/mpc/mpc_plan.hpp"

namespace prowl {

/// Torques for a robot's control loop, while another thread plans: keeps the plan that acts and the next one. Nothing
/// is allocated after construction.
class PlanExecutor {
 public:
  /// Begins with a plan, e.g. MpcController::latest() after its construction.
  PlanExecutor(const RobotModel& robot, const MpcPlan& first);

  /// For the planning thread: `plan` acts from its start on, and replaces one that has not begun.
  void offer(const MpcPlan& plan);

  /// For the control loop: torques at time t [s] for the state (q, v) at that time, of the latest plan that has begun,
  /// with its gains, within the limits. After its end, torques that damp the joints. Never waits: while offer() copies,
  /// the plan before goes on.
  void torque(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& v, Eigen::VectorXd& tau);

 private:
  RobotModel robot_;
  MpcPlan acting_, next_;
  std::mutex lock_;  ///< of next_ and has_next_
  bool has_next_ = false;
};

}  // namespace prowl
