#pragma once

#include <functional>
#include <string>
#include <vector>

#include "prowl/mpc/mpc_controller.hpp"
#include "prowl/simulation/simulation.hpp"

namespace prowl {

/// A command from a time on. An empty gait leaves the one before.
struct TimedCommand {
  double time = 0.0;  ///< [s]
  MpcCommand command;
  std::string gait = {};
};

/// What becomes of a plan that was not ready in time.
enum class LatePlans {
  act,   ///< it acts at the end of the budget all the same: results do not depend on the machine
  drop,  ///< it is lost
};

struct OnlineOptions {
  MpcOptions mpc;  ///< its delay is set from those below
  std::string gait = "trot";
  std::vector<TimedCommand> commands;  ///< in the order of time; before the first: stay
  double duration = 10.0;              ///< [s]
  double period = 0.01;                ///< between two plans [s]
  double budget = 0.01;                ///< from a measured state to the time at which its plan acts [s]
  LatePlans late = LatePlans::act;
  /// Computing times of plans [s], in order, in place of those measured: repeats a run with LatePlans::drop.
  std::vector<double> replayed_times = {};
  /// As in a simulation of a plan; `physics.friction` is that of the ground, `ground.tilt` an unknown slope, `pushes`
  /// the kicks. Not used: open_loop, record_rate, start.
  SimulationOptions simulation;
};

/// What came of a run. A fall ends it.
struct OnlineResult {
  using End = SimulationResult::End;
  End end = End::finished;
  double end_time = 0.0;              ///< [s]
  std::vector<std::string> failures;  ///< in words; empty: success
  bool success() const { return failures.empty(); }

  double velocity_error = 0.0;        ///< RMS of the base's horizontal velocity from the command [m/s]
  double turn_error = 0.0;            ///< RMS of its turn rate from the command [rad/s]
  double last_velocity = 0.0;         ///< distance of the mean velocity of the last second from the command [m/s]
  double largest_torque_share = 0.0;  ///< of the limit [-]
  std::vector<std::string> touches;   ///< of anything but feet on the ground, each once
  MpcCounters counters;
  std::vector<double> times;  ///< computing time of each plan, CPU time of the thread [s]
  long dropped = 0;           ///< plans that were late and lost
  /// State of the base, ten times a second: time, position (3), roll pitch yaw (3), velocity in the world (3).
  std::vector<Eigen::Matrix<double, 10, 1>> path;
};

/// Runs a robot on flat ground under an MpcController in MuJoCo: sensors with noise, contact switches in the feet,
/// delay, state estimator. It begins standing. `on_time(t, end)` is called at every control step; it may be empty.
/// Throws InputError for a gait that the robot cannot do, and for options out of range.
OnlineResult run_online(const RobotModel& robot, const OnlineOptions& options,
                        const std::function<void(double t, double end)>& on_time = {});

}  // namespace prowl
