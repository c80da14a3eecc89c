#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "prowl/simulation/physics.hpp"
#include "prowl/simulation/push.hpp"
#include "prowl/simulation/start_state.hpp"

namespace prowl {

/// Standard deviations of white sensor noise, per sample. Every sensor also has a constant bias,
/// drawn once from the same distribution.
struct SensorNoise {
  double encoder = 1e-3;        ///< [rad]
  double gyro = 2e-3;           ///< [rad/s]
  double accelerometer = 0.05;  ///< [m/s^2]
};

/// What a simulation has to keep to succeed (docs/simulation.md). `[simulation]` of a task file can only ask for more.
struct SuccessCriteria {
  double position = 0.02;  ///< of the base at rest from the end of the plan, and at a goal from its bounds [m]
  double angle = 0.035;    ///< likewise; also of joints at a goal [rad]
  /// Of a landing from its foothold, of the slip of a stance, and of the height missing in a flight: a share of the
  /// standing height, and at most that length [m].
  double distance_share = 0.05, distance = 0.03;
  double delay_share = 0.25, delay = 0.1;  ///< of landings and lift-offs: a share of the swing, and at most that [s]
  double at_limit = 0.05;                  ///< share of the time with a torque at its limit
  double rest = 1.5;                       ///< standing time after the plan's end, none after a cycle [s]
};

constexpr double kRecordRate = 200.0;  ///< default of the front ends [Hz]

/// Error of the ground: all surfaces raised, and turned about the place under the base at the start.
struct GroundError {
  double height = 0.0;                             ///< [m]
  Eigen::Vector2d tilt = Eigen::Vector2d::Zero();  ///< about x and y [rad]
};

struct SimulationOptions {
  double control_rate = 1000.0;  ///< [Hz]
  SensorNoise noise;
  double noise_scale = 1.0;    ///< factor on all sensor noise
  double unknown_noise = 1.0;  ///< another, which the estimator does not know
  double delay = 2e-3;         ///< from sensor reading to torque [s]
  double unknown_delay = 0.0;  ///< additional delay, unknown to the controller [s]; total delay >= 0
  double bandwidth = 0.0;      ///< of the first-order actuators [Hz]; 0: ideal
  bool perfect_state = false;  ///< give the controller the true state
  bool open_loop = false;      ///< feedforward torques only
  PhysicsOptions physics;
  GroundError ground;
  std::optional<StartError> start = {};  ///< nullopt: a small one from the seed if there is noise (docs/simulation.md)
  std::vector<Push> pushes;
  std::uint64_t seed = 1;
  double record_rate = 0.0;  ///< of SimulationResult::samples [Hz]; 0: none

  double control_period() const { return 1.0 / control_rate; }  ///< [s]
  /// Physics steps in a control period: equal ones, not longer than physics.step.
  int substeps() const {
    constexpr double kRounding = 1e-6;
    return std::max(1, static_cast<int>(std::ceil(control_period() / physics.step - kRounding)));
  }
  /// The physics with that step.
  PhysicsOptions stepped_physics() const {
    PhysicsOptions stepped = physics;
    stepped.step = control_period() / substeps();
    return stepped;
  }
};

/// Throws InputError for an option out of range; `nu`: number of the robot's joints.
void check_simulation_options(const SimulationOptions& options, int nu);

}  // namespace prowl
