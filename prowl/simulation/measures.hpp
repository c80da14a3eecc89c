#pragma once

#include "prowl/simulation/actuators.hpp"
#include "prowl/simulation/simulation.hpp"

namespace prowl {

/// Collects a SimulationResult, sample by sample of the controller.
class Measures {
 public:
  /// `end`: when the simulation is to end [s].
  Measures(const MotionProblem& problem, const Tracker& tracker, double end);

  /// A sample. `slip`: way of each contact's material along its surface since the one before [m], world
  /// frame.
  void add(const SimulationSample& sample, const std::vector<Eigen::Vector3d>& slip);
  /// Torques of a physics step of `dt`, at the joints, which turn at v.
  void add_torques(const Actuators& actuators, const Eigen::VectorXd& tau, const Eigen::VectorXd& v, double dt);

  /// All but end, samples and failures.
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
  std::vector<std::vector<bool>> touches_;  ///< one a contact, at each of the times
  SimulationResult result_;
  double time_ = 0.0, saturated_ = 0.0;
};

}  // namespace prowl
