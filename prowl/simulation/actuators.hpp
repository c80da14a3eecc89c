#pragma once

#include <Eigen/Core>
#include <deque>

#include "prowl/model/robot_model.hpp"

namespace prowl {

/// Joint torques: the command after a delay and a first-order low-pass, clamped to the limits at
/// the true joint position and velocity.
class Actuators {
 public:
  /// `delay` [s] is rounded to steps of `dt` [s]; `bandwidth` [Hz], 0: no filter; `initial`: nu
  /// torques [N m].
  Actuators(const RobotModel& robot, double dt, double delay, double bandwidth, const Eigen::VectorXd& initial);

  void command(const Eigen::VectorXd& tau);  ///< nu [N m]
  /// Advances by dt; torques (nu) at the true state.
  const Eigen::VectorXd& step(const Eigen::VectorXd& q, const Eigen::VectorXd& v);
  /// Last step: largest torque as a share of its limit, index of that joint, true at or above 1.
  double largest_share() const { return largest_share_; }
  int most_used() const { return most_used_; }
  bool saturated() const { return largest_share_ >= 1.0; }

 private:
  const RobotModel& robot_;
  long delay_steps_, now_ = 0;
  double share_;                                           ///< of the remaining difference, filtered per step
  std::deque<std::pair<long, Eigen::VectorXd>> commands_;  ///< each with the step at which it takes effect
  Eigen::VectorXd wanted_, filtered_, torque_;
  double largest_share_ = 0.0;
  int most_used_ = 0;
};

}  // namespace prowl
