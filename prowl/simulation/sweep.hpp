#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <random>

#include "prowl/motion/disturbances.hpp"
#include "prowl/simulation/simulation.hpp"

namespace prowl {

/// Ranges of the simulated world around the planned one, for uniform distributions. Lengths and velocities scale as
/// those of kSweptDisturbances.
struct PerturbationRanges {
  double base_position = kSweptDisturbances.base_position,
         base_angle = kSweptDisturbances.base_angle;  ///< of the start, each axis [m, rad]
  double base_velocity = kSweptDisturbances.base_velocity,
         base_rate = kSweptDisturbances.base_rate;  ///< likewise [m/s, rad/s]
  double joint = 0.01;                              ///< of the start, where no contact holds [rad]
  double mass = kSweptDisturbances.mass;            ///< factor on mass and inertia of each body: 1 - mass to 1 + mass
  double base_center = kSweptDisturbances.center;   ///< centre of mass of the base, each axis [m]
  double friction_low = 1.0 - kSweptDisturbances.friction, friction_high = 1.6;  ///< factor on the planned coefficients
  double bandwidth_low = 20.0, bandwidth_high = 60.0;                            ///< of the actuators [Hz]
  double delay_low = 1e-3, delay_high = 4e-3;  ///< from sensors to torques [s]; the controller knows its own value
  double ground_height = 0.005, ground_tilt = 0.035;  ///< [m, rad]: 2 degrees
  double noise_low = 0.5, noise_high = 2.0;           ///< factor on what the estimator is told
  double push_velocity = kSweptDisturbances.push;     ///< impulse over mass, in a random horizontal direction [m/s]
  double push_duration = kSweptDisturbances.push_duration;  ///< [s]; starts at a random time of the motion
  std::optional<double> push, push_on_two_feet;  ///< replace that impulse [N s]; the second with two contacts or fewer
  bool operator==(const PerturbationRanges&) const = default;
};

/// The start of a case: draws within `share` of the default ranges.
StartError draw_start_error(const RobotModel& robot, double share, std::mt19937_64& random,
                            const PerturbationRanges& ranges = {});

/// `options` with world, start, a push and the sensor seed drawn from `seed` alone.
SimulationOptions perturbed(const MotionProblem& problem, const Tracker& tracker, const SimulationOptions& options,
                            const PerturbationRanges& ranges, std::uint64_t seed);

/// Mass of the simulated robot over that of the plan.
double mass_factor(const RobotModel& robot, const PhysicsOptions& physics);

/// Name of the phase at the middle of the first push; "" without one.
std::string pushed_phase(const Tracker& tracker, const SimulationOptions& options);

struct SweepCase {
  SimulationOptions options;
  SimulationResult result;  ///< without samples
};

/// Progress: simulations done, from 0 to total. May be empty.
using SweepProgress = std::function<void(int done, int total)>;

/// Runs simulate() on all `options`, one thread per core; the result does not depend on the number
/// of threads. `on_done` is called from any thread, one call at a time. When `interrupt` (may be
/// null) becomes true, no further case starts; the result contains the first cases of `options`.
std::vector<SweepCase> run_cases(const MotionProblem& problem, const Tracker& tracker, const SuccessCriteria& criteria,
                                 const std::vector<SimulationOptions>& options, const SweepProgress& on_done,
                                 const std::atomic<bool>* interrupt);

/// Success rate with its 95 % confidence interval (Clopper and Pearson, Biometrika 1934: exact,
/// hence conservative).
struct SuccessRate {
  int successes = 0, cases = 0;
  double rate() const { return cases > 0 ? static_cast<double>(successes) / cases : 0.0; }
  double lower = 0.0, upper = 1.0;
};
SuccessRate success_rate(int successes, int cases);

/// Size of a single kind of perturbation at which the success rate falls below one half.
struct Breakdown {
  std::string kind;  ///< "masses larger by", ...
  std::string unit;
  double holds = 0.0;  ///< largest tried size with at least half of the cases successful
  double fails = 0.0;  ///< smallest tried size above it with fewer; infinity if none
};

/// Finds the breakdown of each kind by bisection with `cases` simulations per size: masses larger
/// and smaller, less friction, pushes, noise, delay. The total of `on_done` is an upper bound;
/// skipped simulations count as done when a kind is finished. When `interrupt` (may be null)
/// becomes true, unfinished kinds are left out.
std::vector<Breakdown> find_breakdowns(const MotionProblem& problem, const Tracker& tracker,
                                       const SuccessCriteria& criteria, const SimulationOptions& options,
                                       std::uint64_t seed, int cases, const SweepProgress& on_done,
                                       const std::atomic<bool>* interrupt);

}  // namespace prowl
