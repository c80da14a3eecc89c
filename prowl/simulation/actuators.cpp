#include "prowl/simulation/actuators.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "prowl/model/torque_share.hpp"

namespace prowl {

Actuators::Actuators(const RobotModel& robot, double dt, double delay, double bandwidth, const Eigen::VectorXd& initial)
    : robot_(robot),
      delay_steps_(std::lround(delay / dt)),
      share_(bandwidth > 0.0 ? -std::expm1(-2.0 * std::numbers::pi * bandwidth * dt) : 1.0),
      wanted_(initial),
      filtered_(initial),
      torque_(initial) {}

void Actuators::command(const Eigen::VectorXd& tau) { commands_.emplace_back(now_ + delay_steps_, tau); }

const Eigen::VectorXd& Actuators::step(const Eigen::VectorXd& q, const Eigen::VectorXd& v) {
  while (!commands_.empty() && commands_.front().first <= now_) {
    wanted_ = commands_.front().second;
    commands_.pop_front();
  }
  ++now_;
  filtered_ += share_ * (wanted_ - filtered_);
  largest_share_ = 0.0;
  for (int j = 0; j < robot_.nu(); ++j) {
    const double lower = robot_.torque_lower(j, q(7 + j), v(6 + j)), upper = robot_.torque_upper(j, q(7 + j), v(6 + j));
    torque_(j) = std::clamp(filtered_(j), lower, upper);
    const double share = torque_share(robot_, j, q(7 + j), v(6 + j), torque_(j));
    if (share <= largest_share_) continue;
    largest_share_ = share;
    most_used_ = j;
  }
  return torque_;
}

}  // namespace prowl
