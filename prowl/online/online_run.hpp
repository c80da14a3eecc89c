#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "prowl/online/online_result.hpp"
#include "prowl/online/outside_controller.hpp"

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
  wait,  ///< it acts as soon as it is ready; the next state is measured then
};

/// In the order of LatePlans.
const std::vector<std::string>& late_plans_names();
/// Throws InputError for a name that is none of these.
LatePlans late_plans_named(const std::string& name);

struct OnlineOptions {
  MpcOptions mpc;  ///< its delay is set from those below
  std::string gait = "trot";
  std::vector<TimedCommand> commands;  ///< in the order of time; before the first: stay
  double duration = 10.0;              ///< [s]
  double period = 0.01;                ///< between two plans [s]
  double budget = 0.01;                ///< computing time allowed for a plan [s]; with the delay at most seven periods
  LatePlans late = LatePlans::act;
  /// Computing times of plans [s], finite and >= 0, in order, in place of those measured: repeats a run with
  /// LatePlans::drop or wait.
  std::vector<double> replayed_times = {};
  Planner planner = {};  ///< in the place of an MpcController, if it is set
  /// As in a simulation of a plan; `physics.friction` is that of the ground, `ground.tilt` an unknown slope, `pushes`
  /// the kicks. Not used: open_loop, start.
  SimulationOptions simulation;
};

/// One control step of a run, for a watcher, and what the watcher asks for.
struct OnlineMoment {
  double time = 0.0, end = 0.0;                 ///< [s]
  const std::function<OnlineSample()>& sample;  ///< of the robot at this time
  std::optional<TimedCommand> command = {};     ///< from now on; its time is not used
  std::optional<Eigen::Vector3d> impulse = {};  ///< push of the base from now on for 0.1 s, world frame [N s]
  bool stops = false;                           ///< ends the run here
};
using OnlineWatcher = std::function<void(OnlineMoment&)>;

/// Gaits of a run in order: the first one, and those of the commands until its end.
std::vector<std::string> gaits_of(const OnlineOptions& options);

/// The ground of a run as it is: its friction, height and slope.
Surface ground_of(const OnlineOptions& options);

/// Runs a robot on flat ground under an MpcController, or a planner of the user's own, in MuJoCo: sensors with noise,
/// contact switches in the feet, delay, state estimator. It begins standing. `watch` is called at every control step;
/// it may be empty. Throws InputError for a gait that the robot cannot do, and for options out of range.
OnlineResult run_online(const RobotModel& robot, const OnlineOptions& options, const OnlineWatcher& watch = {});

}  // namespace prowl
