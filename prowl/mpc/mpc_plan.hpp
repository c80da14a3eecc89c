#pragma once

#include <Eigen/Core>
#include <vector>

#include "prowl/model/robot_model.hpp"

namespace prowl {

/// The motion of a horizon with feedback gains, step by step, and its control law:
///
///   tau = tau_k + K_k (x (-) x*(t)),  within the torque limits of the robot
///
/// The second term is limited to a share of each joint's torque limit: gains are valid for one active set. Far from the
/// plan, with another active set, they may be ten times too large, and topple a robot in 10 ms.
/// x (-) x* is (base displacement, world [m]; rotation vector from R* to R [rad]; joints; velocities, as RobotModel).
/// A Tracker has gains for x* (-) x instead: they have the other sign.
/// No function allocates but the constructor. They use work space of the plan: one thread at a time.
class MpcPlan {
 public:
  struct Step {
    double start = 0.0, length = 0.0;  ///< [s]
    unsigned standing = 0;             ///< bit f: foot f stands
    Eigen::VectorXd q, v;              ///< at the start, as RobotModel
    Eigen::VectorXd a;                 ///< constant over the step [m/s^2, rad/s^2], coordinates of v
    Eigen::VectorXd tau;               ///< constant over the step, joint torques [N m]
    Eigen::VectorXd force;             ///< 3 per contact of the robot, world frame, at this plan's linearisation [N]
    Eigen::MatrixXd gain;              ///< K, nu x 2 nv [N m per unit of x (-) x*]
  };

  static constexpr double kMostFeedback = 0.2;
  /// `most_feedback`: that share. The robot must outlive the plan.
  MpcPlan(const RobotModel& robot, int steps, double most_feedback = kMostFeedback);

  double most_feedback() const { return most_feedback_; }
  std::vector<Step>& steps() { return steps_; }
  const std::vector<Step>& steps() const { return steps_; }
  double start() const { return steps_.front().start; }
  double end() const { return steps_.back().start + steps_.back().length; }
  const Step& step_at(double t) const;  ///< the first or last one beyond the ends

  /// x*(t); beyond the end the motion of the last step goes on for at most its length.
  void state(double t, Eigen::VectorXd& q, Eigen::VectorXd& v) const;
  /// Mean over a span of time [s] of the torques tau_k; beyond the end those of the last step.
  void mean_torques(double from, double to, Eigen::VectorXd& tau) const;
  /// tau for a state (q, v) at time t [s]. A state that is not finite gives tau_k alone, within the limits.
  void torque(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& v, Eigen::VectorXd& tau) const;

 private:
  const RobotModel& robot_;
  double most_feedback_;
  std::vector<Step> steps_;
  mutable Eigen::VectorXd q_, v_, deviation_, feedback_;
};

/// Clamps torques to the limits of the robot at joint positions and velocities of the state (q, v).
void clamp_torques(const RobotModel& robot, const Eigen::VectorXd& q, const Eigen::VectorXd& v, Eigen::VectorXd& tau);

/// Torques that damp the joints, within their limits; zero for a state that is not finite.
void damping_torques(const RobotModel& robot, const Eigen::VectorXd& q, const Eigen::VectorXd& v, Eigen::VectorXd& tau);

}  // namespace prowl
