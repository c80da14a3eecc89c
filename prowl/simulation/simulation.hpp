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

/// One instant: reference, true and estimated state.
struct SimulationSample {
  double time = 0.0;                           ///< [s]
  Eigen::VectorXd q_ref, v_ref;                ///< of the plan
  Eigen::VectorXd q_tracked;                   ///< of the plan, with the feet on the ground that they found
  Eigen::VectorXd q, v;                        ///< true
  Eigen::VectorXd q_seen, v_seen;              ///< estimate given to the controller
  Eigen::VectorXd feedforward, feedback, tau;  ///< nu [N m]; tau acts at the joints, the others are commands
  std::vector<ContactReading> contacts;        ///< during the last physics step
};

/// A planned contact switch, and what came of it.
struct ContactSwitch {
  int contact = 0;
  bool lands = false;
  double planned = 0.0;   ///< [s]
  double measured = 0.0;  ///< first touch or last touch of the swing [s]; NaN if there was none
  double swing = 0.0;     ///< duration of the swing [s]
  // Of a landing that happened:
  double off = 0.0;  ///< distance from the planned place, along the surface [m]
  bool on_its_surface = true;
};

/// Distances from the bounds of a goal, at its time.
struct GoalError {
  std::string name;
  double position = 0.0, angle = 0.0;  ///< of the base [m, rad]
  double joint = 0.0;                  ///< of the worst joint that the goal bounds [rad]
  std::string worst_joint;
};

/// Height in the middle of a phase without contacts.
struct FlightHeight {
  std::string phase;
  double missing = 0.0;  ///< planned less true height of the base [m]
};

struct SimulationResult {
  enum class End { finished, fell, diverged };
  End end = End::finished;
  double end_time = 0.0;              ///< [s]
  std::string phase;                  ///< name of the last phase
  std::vector<std::string> failures;  ///< violated criteria in words; empty: success
  bool success() const { return failures.empty(); }

  ErrorMeasure base_position;                                            ///< [m], distance from the planned base
  ErrorMeasure base_angle;                                               ///< [rad]
  ErrorMeasure joints;                                                   ///< [rad], of the worst joint; rms of all
  ErrorMeasure estimated_position, estimated_angle, estimated_velocity;  ///< [m, rad, m/s], error of the estimate
  double estimated_joint_rate = 0.0;                                     ///< [rad/s], rms of all joints
  std::vector<double> slip;  ///< per contact: largest slip along its surface under load in one stance [m]
  std::vector<ContactSwitch> switches;
  std::vector<GoalError> goals;       ///< of those that came before the end
  std::vector<FlightHeight> flights;  ///< likewise
  std::vector<std::string> touches;   ///< of anything but contacts on surfaces, each once: "trunk and floor at 1.234 s"
  double largest_torque_share = 0.0;  ///< of the limit
  std::string largest_torque_joint;
  double saturated = 0.0;      ///< share of the time with a torque at its limit
  double positive_work = 0.0;  ///< of the joints [J]
  std::vector<SimulationSample> samples;
};

const char* to_string(SimulationResult::End end);  ///< as in simulate.json

/// Runs a plan with its tracker in MuJoCo (docs/simulation.md). `tracker` has one segment per phase
/// of the problem, and optionally one for standing after the end. Ends early if the robot falls:
/// has_fallen(). Deterministic, bit for bit. Throws InputError if the parts do not fit each other
/// or an option is out of range. `on_time(t, end)` [s] is called at every control step; it may be
/// empty, and its exceptions pass through.
SimulationResult simulate(const MotionProblem& problem, const Tracker& tracker, const SuccessCriteria& criteria,
                          const SimulationOptions& options,
                          const std::function<void(double t, double end)>& on_time = {});

/// Phase of a segment of the tracker: after the end the robot stands on as in the last.
const Phase& phase_of_segment(const MotionProblem& problem, std::size_t segment);

/// Throws InputError unless robot, contacts and phases of tracker and problem agree.
void check_fit(const MotionProblem& problem, const Tracker& tracker);

}  // namespace prowl
