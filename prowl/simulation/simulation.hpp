#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "prowl/motion/motion_problem.hpp"
#include "prowl/simulation/simulation_options.hpp"
#include "prowl/tracker/tracker.hpp"
#include "prowl/trajectory/tracking_error.hpp"

namespace prowl {

/// One instant, as it was and as it was meant and believed to be.
struct SimulationSample {
  double time = 0.0;                           ///< [s]
  Eigen::VectorXd q_ref, v_ref;                ///< of the plan
  Eigen::VectorXd q, v;                        ///< true
  Eigen::VectorXd q_seen, v_seen;              ///< what the controller is given
  Eigen::VectorXd feedforward, feedback, tau;  ///< nu [N m]; tau at the joints, the others as commanded
  std::vector<ContactReading> contacts;        ///< during the last physics step
};

/// A planned change of contact, and when it happened.
struct ContactSwitch {
  int contact = 0;
  bool lands = false;
  double planned = 0.0;   ///< [s]
  double measured = 0.0;  ///< first touch or last touch of the swing [s]; NaN if there was none
};

struct SimulationResult {
  enum class End { finished, fell, diverged };
  End end = End::finished;
  double end_time = 0.0;              ///< [s]
  std::string phase;                  ///< during which it ended
  std::vector<std::string> failures;  ///< of the criteria, in words; empty: success
  bool success() const { return failures.empty(); }

  ErrorMeasure base_position;                                            ///< [m], distance from the plan's base
  ErrorMeasure base_angle;                                               ///< [rad]
  ErrorMeasure joints;                                                   ///< [rad], of the worst joint; rms of all
  ErrorMeasure estimated_position, estimated_angle, estimated_velocity;  ///< [m, rad, m/s], of what the controller sees
  double estimated_joint_rate = 0.0;                                     ///< [rad/s], rms of all joints
  std::vector<double> slip;  ///< one a contact, farthest from where it began to stand [m]
  std::vector<ContactSwitch> switches;
  double largest_torque_share = 0.0;  ///< of the limit
  std::string largest_torque_joint;
  double saturated = 0.0;      ///< share of the time in which some torque is at its limit
  double positive_work = 0.0;  ///< of the joints [J]
  std::vector<SimulationSample> samples;
};

/// Runs a plan with its tracker in MuJoCo (docs/simulation.md). `tracker` has one segment for each phase of the
/// problem, and may have another one to stand on after the end. Ends early if the robot falls, by has_fallen(). Same
/// arguments, same result, bit for bit. Throws InputError if the parts do not fit each other or an option makes no
/// sense. `on_time(t, end)` is called as it goes on [s]; it may be empty, and what it throws ends it.
SimulationResult simulate(const MotionProblem& problem, const Tracker& tracker, const SuccessCriteria& criteria,
                          const SimulationOptions& options,
                          const std::function<void(double t, double end)>& on_time = {});

/// Throws InputError if the tracker is of another robot or of other phases than the problem.
void check_fit(const MotionProblem& problem, const Tracker& tracker);

/// In words, which of the criteria the base in rest at the end does not meet.
std::vector<std::string> failures_in_rest(const ErrorMeasure& base_position, const ErrorMeasure& base_angle,
                                          const SuccessCriteria& criteria);

}  // namespace prowl
