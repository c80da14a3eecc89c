#include "prowl/mpc/plan_executor.hpp"

#include <utility>

namespace prowl {

PlanExecutor::PlanExecutor(const RobotModel& robot, const MpcPlan& first)
    : robot_(robot), acting_(robot_, static_cast<int>(first.steps().size())), next_(acting_) {
  acting_.steps() = first.steps();
}

void PlanExecutor::offer(const MpcPlan& plan) {
  const std::lock_guard guard(lock_);
  next_.steps() = plan.steps();
  has_next_ = true;
}

void PlanExecutor::torque(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& v, Eigen::VectorXd& tau) {
  if (const std::unique_lock guard(lock_, std::try_to_lock); guard && has_next_ && next_.start() <= t) {
    std::swap(acting_.steps(), next_.steps());
    has_next_ = false;
  }
  t <= acting_.end() ? acting_.torque(t, q, v, tau) : damping_torques(robot_, q, v, tau);
}

}  // namespace prowl
