#pragma once

#include "prowl/estimation/state_estimator.hpp"
#include "prowl/motion/motion_problem.hpp"
#include "prowl/simulation/simulation_options.hpp"
#include "prowl/tracker/tracker.hpp"

namespace prowl {

/// What runs on the robot: from sensor readings to torques. Knows the plan, the robot as modelled, how noisy its
/// sensors are and how long its torques take; nothing of the truth unless it is told.
class Onboard {
 public:
  /// Commands are `period` [s] apart.
  Onboard(const MotionProblem& problem, const Tracker& tracker, const SimulationOptions& options, double period);

  /// Takes the reading at time t. be_told() in its place: the true state.
  void sense(double t, const SensorReading& reading);
  void be_told(const Eigen::VectorXd& q, const Eigen::VectorXd& v) { estimator_.set(q, v); }
  const Eigen::VectorXd& q() const { return estimator_.q(); }
  const Eigen::VectorXd& v() const { return estimator_.v(); }

  /// Torques to command at time t, for the moment at which they will act.
  void act(double t);
  const Eigen::VectorXd& feedforward() const { return feedforward_; }
  const Eigen::VectorXd& feedback() const { return feedback_; }
  const Eigen::VectorXd& command() const { return command_; }

 private:
  const Stand& stand(double t) const;

  const Tracker& tracker_;
  const SimulationOptions& options_;
  double period_;
  std::vector<Stand> stands_;  ///< of each segment of the tracker
  StateEstimator estimator_;
  std::vector<Eigen::VectorXd>
      commands_;  ///< that are on their way, oldest first; the first acts until the next reading
  Eigen::VectorXd feedforward_, feedback_, command_, q_, v_;
};

}  // namespace prowl
