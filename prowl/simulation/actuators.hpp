#pragma once

#include <Eigen/Core>
#include <deque>

#include "prowl/model/robot_model.hpp"

namespace prowl {

/// Torque at the joints: the commanded one after a delay, through a filter of first order, within the limits that the
/// joints have at their true position and velocity.
class Actuators {
 public:
  /// `delay` is rounded to steps of `dt`; bandwidth [Hz], 0 for none. Starts with the torques `initial`.
  Actuators(const RobotModel& robot, double dt, double delay, double bandwidth, const Eigen::VectorXd& initial);

  void command(const Eigen::VectorXd& tau);
  /// Torques of the next step of dt, at the true state.
  const Eigen::VectorXd& step(const Eigen::VectorXd& q, const Eigen::VectorXd& v);
  /// Of the last step: the largest torque as a share of its limit, whose it is, and whether it is at the limit.
  double largest_share() const { return largest_share_; }
  int most_used() const { return most_used_; }
  bool saturated() const { return largest_share_ >= 1.0; }

 private:
  const RobotModel& robot_;
  long delay_steps_, now_ = 0;
  double share_;                                           ///< of the way to the command in one step
  std::deque<std::pair<long, Eigen::VectorXd>> commands_;  ///< with the step at which each begins to count
  Eigen::VectorXd wanted_, filtered_, torque_;
  double largest_share_ = 0.0;
  int most_used_ = 0;
};

}  // namespace prowl
