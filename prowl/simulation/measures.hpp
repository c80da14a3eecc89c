#pragma once

#include "prowl/simulation/actuators.hpp"
#include "prowl/simulation/simulation.hpp"

namespace prowl {

/// Accumulates a SimulationResult over the samples of the controller.
class Measures {
 public:
  /// `end`: planned end of the simulation [s].
  Measures(const MotionProblem& problem, const Tracker& tracker, double end);

  /// `slip`: displacement of each contact's material along its surface since the last sample, world
  /// frame [m].
  void add(const SimulationSample& sample, const std::vector<Eigen::Vector3d>& slip);
  /// One physics step of `dt` [s] with joint torques tau (nu) and velocity v (nv).
  void add_torques(const Actuators& actuators, const Eigen::VectorXd& tau, const Eigen::VectorXd& v, double dt);

  /// Sets everything except end, samples and failures.
  SimulationResult result() const;

 private:
  double touch_near(int contact, double from, double to, bool lands) const;

  const MotionProblem& problem_;
  const Tracker& tracker_;
  double end_;
  TrackingError error_;
  ErrorSum estimated_position_, estimated_angle_, estimated_velocity_, estimated_rates_;
  std::vector<Eigen::Vector3d> slip_now_;
  std::vector<double> slip_;
  std::vector<double> times_;
  std::vector<std::vector<bool>> touches_;  ///< per contact, at each of the times
  SimulationResult result_;
  double time_ = 0.0, saturated_ = 0.0;
};

}  // namespace prowl
