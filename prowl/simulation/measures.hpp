#pragma once

#include <optional>
#include <set>
#include <string>

#include "prowl/simulation/actuators.hpp"
#include "prowl/simulation/simulation.hpp"

namespace prowl {

/// Accumulates a SimulationResult over the samples of the controller.
class Measures {
 public:
  /// `end`: planned end of the simulation [s].
  Measures(const MotionProblem& problem, const Tracker& tracker, const Physics& physics, double end);

  /// `slip`: displacement of each contact's material along its surface since the last sample, world
  /// frame [m].
  void add(const SimulationSample& sample, const std::vector<Eigen::Vector3d>& slip);
  /// `what` touched at time t [s], none of it a contact on a surface.
  void add_touch(const std::string& what, double t);
  /// One physics step of `dt` [s] with joint torques tau (nu) and velocity v (nv).
  void add_torques(const Actuators& actuators, const Eigen::VectorXd& tau, const Eigen::VectorXd& v, double dt);

  /// Sets everything except end, samples and failures. Call it once, at the end.
  SimulationResult result();

 private:
  /// What is measured at one time of the plan.
  struct Moment {
    double time;
    const BoundaryConstraint* goal;  ///< or the middle of a flight
    std::string phase;
  };
  void add_moment(const Moment& moment, const SimulationSample& sample);
  struct Found {
    std::size_t sample, contact;
  };
  std::optional<Found> touch_near(int contact, double from, double to, bool lands) const;
  void add_switch(int contact, bool lands, std::size_t segment, double swing, double from, double to);
  void add_stray(int contact, double from, double to);
  int planned_surface(int contact, std::size_t segment) const;

  const MotionProblem& problem_;
  const Tracker& tracker_;
  const Physics& physics_;
  double end_;
  std::vector<Moment> moments_;  ///< in the order of their times
  std::size_t next_moment_ = 0;
  TrackingError error_;
  ErrorSum estimated_position_, estimated_angle_, estimated_velocity_, estimated_rates_;
  std::vector<Eigen::Vector3d> slip_now_;
  std::vector<double> slip_;
  std::vector<double> times_;
  struct Touch {
    int surface;  ///< -1: none
    Eigen::Vector3d position;
  };
  std::vector<std::vector<Touch>> touches_;  ///< per contact, at each of the times
  std::set<std::string> touched_;
  SimulationResult result_;
  double time_ = 0.0, saturated_ = 0.0;
};

}  // namespace prowl
