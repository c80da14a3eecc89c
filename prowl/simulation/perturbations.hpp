#pragma once

#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "prowl/motion/disturbances.hpp"
#include "prowl/motion/motion_problem.hpp"
#include "prowl/simulation/simulation_options.hpp"
#include "prowl/tracker/tracker.hpp"

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

/// Kinds of perturbations, by their names.
std::vector<std::string> perturbation_kinds();
/// `ranges` without the kinds that `kinds` leaves out; empty: none. Throws InputError for an unknown name.
PerturbationRanges only(const std::vector<std::string>& kinds, PerturbationRanges ranges = {});

/// Draws evenly between both; as many random numbers for equal ones.
double draw_between(double low, double high, std::mt19937_64& random);
/// A random horizontal unit vector.
Eigen::Vector3d draw_direction(std::mt19937_64& random);

/// A push in a random horizontal direction, at a random time of the motion. `on_two_feet`: its impulse [N s] where at
/// most two contacts hold.
Push draw_push(const Tracker& tracker, double impulse, double on_two_feet, double duration, std::mt19937_64& random);

/// The start of a case: draws within `share` of the default ranges.
StartError draw_start_error(const RobotModel& robot, double share, std::mt19937_64& random,
                            const PerturbationRanges& ranges = {});

/// `options` with world, start, a push and the sensor seed drawn from `seed` alone. What is left out of `ranges`
/// changes none of the other draws.
SimulationOptions perturbed(const MotionProblem& problem, const Tracker& tracker, const SimulationOptions& options,
                            const PerturbationRanges& ranges, std::uint64_t seed);

/// Mass of the simulated robot over that of the plan.
double mass_factor(const RobotModel& robot, const PhysicsOptions& physics);

/// Name of the phase at the middle of the first push; "" without one.
std::string pushed_phase(const Tracker& tracker, const SimulationOptions& options);

}  // namespace prowl
