#include "prowl/mpc/plan_executor.hpp"

#include <utility>

namespace prowl {

PlanExecutor::PlanExecutor(const RobotModel& robot, const MpcPlan& first)
    : robot_(robot),
      acting_(robot_, static_cast<int>(first.steps().size()), first.most_feedback()),
      pending_(kMostPending, acting_) {
  acting_.steps() = first.steps();
}

void PlanExecutor::offer(const MpcPlan& plan) {
  const std::lock_guard guard(lock_);
  while (num_pending_ > 0 && pending_[num_pending_ - 1].start() >= plan.start() - kTimeRounding) --num_pending_;
  if (num_pending_ == kMostPending) --num_pending_;
  pending_[num_pending_++].steps() = plan.steps();
}

void PlanExecutor::torque(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& v, Eigen::VectorXd& tau) {
  if (const std::unique_lock guard(lock_, std::try_to_lock); guard) {
    std::size_t begun = 0;
    while (begun < num_pending_ && pending_[begun].start() <= t + kTimeRounding) ++begun;
    if (begun > 0) {
      std::swap(acting_.steps(), pending_[begun - 1].steps());
      for (std::size_t i = begun; i < num_pending_; ++i) std::swap(pending_[i - begun].steps(), pending_[i].steps());
      num_pending_ -= begun;
    }
  }
  t <= acting_.end() ? acting_.torque(t, q, v, tau) : damping_torques(robot_, q, v, tau);
}

}  // namespace prowl
