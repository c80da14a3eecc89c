#pragma once

#include <mutex>
#include <vector>

#include "prowl/mpc/latest_plans.hpp"

namespace prowl {

/// Torques for a robot's control loop, while another thread plans: keeps the plan that acts and those that have not
/// begun. Nothing is allocated after construction.
class PlanExecutor {
 public:
  /// Plans that may wait for their start.
  static constexpr std::size_t kMostPending = LatestPlans::kLongestDelay + 1;

  /// Begins with a plan, e.g. MpcController::latest() after its construction. All have its share of feedback.
  PlanExecutor(const RobotModel& robot, const MpcPlan& first);

  /// For the planning thread: `plan` acts from its start on, and replaces those that would begin later.
  void offer(const MpcPlan& plan);

  /// For the control loop: torques at time t [s] for the state (q, v) at that time, of the newest plan that has begun,
  /// with its gains, within the limits. After its end, torques that damp the joints. Never waits: while offer() copies,
  /// the plan before goes on.
  void torque(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& v, Eigen::VectorXd& tau);

 private:
  RobotModel robot_;
  MpcPlan acting_;
  std::mutex lock_;  ///< of the two below
  std::vector<MpcPlan> pending_;
  std::size_t num_pending_ = 0;  ///< in the order of their starts
};

}  // namespace prowl
