#pragma once

#include "prowl/estimation/ground_estimator.hpp"
#include "prowl/estimation/state_estimator.hpp"
#include "prowl/motion/motion_problem.hpp"
#include "prowl/simulation/simulation_options.hpp"
#include "prowl/tracker/tracker.hpp"

namespace prowl {

/// Unmodelled joint accelerations as white noise [rad²/s³]; choice: docs/simulation.md.
constexpr double kJointDensity = 30.0;

/// Noise assumed by the filter, which divides by it: never zero. `scale`: factor on that of the sensors.
EstimatorNoise estimator_noise(const SensorNoise& sensors, double scale);

/// On-board software: estimators of state and ground, and tracker, from sensor readings to torques. It knows the
/// plan, the nominal robot model, the sensor noise and the delay, but not the true state.
class Onboard {
 public:
  /// `period`: time between commands [s].
  Onboard(const MotionProblem& problem, const Tracker& tracker, const SimulationOptions& options, double period);

  /// Updates the estimate with the reading at time t [s]; be_told() sets the true state instead.
  void sense(double t, const SensorReading& reading);
  void be_told(const Eigen::VectorXd& q, const Eigen::VectorXd& v) { estimator_.set(q, v); }
  const Eigen::VectorXd& q() const { return estimator_.q(); }
  const Eigen::VectorXd& v() const { return estimator_.v(); }

  /// Computes the torques commanded at time t [s], for the time at which they take effect.
  void act(double t);
  const Eigen::VectorXd& feedforward() const { return feedforward_; }
  const Eigen::VectorXd& feedback() const { return feedback_; }
  /// Step (nv) from the planned state to the tracked one, whose feet are on the ground that they found.
  const Eigen::VectorXd& ground_correction() const { return ground_correction_; }
  const Eigen::VectorXd& command() const { return command_; }

 private:
  const Stand& stand(double t) const;
  /// What moves the links of a command, at planned rates.
  Eigen::VectorXd moving(const Eigen::VectorXd& command) const;

  const Tracker& tracker_;
  const SimulationOptions& options_;
  double period_;
  std::vector<Stand> stands_;  ///< of each segment of the tracker
  StateEstimator estimator_;
  GroundEstimator ground_;
  const JointLosses& losses_;
  /// Pending, oldest first, less the losses of joints that move as planned; the first acts until the next reading.
  std::vector<Eigen::VectorXd> commands_;
  Eigen::VectorXd feedforward_, feedback_, command_, ground_correction_, q_, v_, q_planned_, v_planned_;
};

}  // namespace prowl
