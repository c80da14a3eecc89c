#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "prowl/mpc/mpc_controller.hpp"
#include "prowl/simulation/simulation.hpp"

namespace prowl {

/// The simulated robot at one time of a run.
struct OnlineSample {
  double time = 0.0;                                    ///< [s]
  Eigen::VectorXd q, v;                                 ///< true state
  Eigen::VectorXd force;                                ///< of each contact on the robot, 3 each, world frame [N]
  Eigen::Vector3d moves = Eigen::Vector3d::Zero();      ///< base ahead and to the left [m/s], turn rate [rad/s]
  Eigen::Vector3d commanded = Eigen::Vector3d::Zero();  ///< the same, as the controller follows it
};

/// Plans whose forces leave their friction cones by more than 1 % of the robot's weight: in the middle of the part that
/// is executed, on level ground with the friction that the controller assumes.
struct ForceCount {
  long plans = 0, outside = 0;
  double share() const { return plans > 0 ? static_cast<double>(outside) / static_cast<double>(plans) : 0.0; }
};

/// What came of a run. A fall ends it, and so may its watcher.
struct OnlineResult {
  enum class End { finished, fell, diverged, stopped };
  End end = End::finished;
  double end_time = 0.0;              ///< [s]
  std::vector<std::string> failures;  ///< in words; empty: success
  std::vector<std::string> notes;     ///< commands out of range, and what comes after the end, in words
  bool success() const { return failures.empty(); }

  // Errors are from the command that the controller follows: within what the legs allow, and smoothed.
  double velocity_error = 0.0;  ///< RMS error of the base's horizontal velocity [m/s]
  double turn_error = 0.0;      ///< RMS error of its turn rate [rad/s]; not judged
  /// Distance of the mean velocity of the last second from the command [m/s]; none if the run ended before.
  std::optional<double> last_velocity;
  double largest_torque_share = 0.0;  ///< of the limit [-]; infinite if a joint is faster than its limits allow
  long control_steps = 0;
  long steps_beyond_limits = 0;      ///< of these: commanded torques more than 1 % beyond a limit at the true state
  ForceCount undisturbed, kicked;    ///< plans made otherwise, and until 0.5 s after a push
  std::vector<std::string> touches;  ///< of anything but feet on the ground, each once
  MpcCounters counters;
  std::vector<double> times;      ///< computing time of each plan, CPU time of the thread [s]
  std::vector<double> feedbacks;  ///< part of these after the state was measured [s]
  std::vector<double> walls;      ///< of each plan, in wall-clock time [s]
  long late = 0;                  ///< plans that took longer than the budget
  long dropped = 0;               ///< of these: lost
  std::vector<OnlineSample> samples;
};

}  // namespace prowl
