#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "prowl/simulation/physics.hpp"

namespace prowl {

/// Standard deviations of white sensor noise, per sample. Every sensor also has a constant bias,
/// drawn once from the same distribution.
struct SensorNoise {
  double encoder = 1e-3;        ///< [rad]
  double gyro = 2e-3;           ///< [rad/s]
  double accelerometer = 0.05;  ///< [m/s^2]
};

/// A constant force on the base's centre of mass during `duration`.
struct Push {
  Eigen::Vector3d impulse = Eigen::Vector3d::Zero();  ///< world frame [N s]
  double time = 0.0;                                  ///< start [s]
  double duration = 0.1;                              ///< [s]
};

/// Success criteria of a simulation; `[simulation]` of the task file.
struct SuccessCriteria {
  double position = 0.02;  ///< distance of the base at rest from the end of the plan [m]
  double angle = 0.035;    ///< its angle, likewise [rad]
  double slip = 0.02;      ///< of a contact in stance [m]
  double rest = 1.5;       ///< standing time after the plan's end, none after a cycle [s]
};

constexpr double kRecordRate = 200.0;  ///< default of the front ends [Hz]

struct SimulationOptions {
  double control_rate = 1000.0;  ///< [Hz]
  SensorNoise noise;
  double noise_scale = 1.0;    ///< factor on all sensor noise
  double delay = 2e-3;         ///< from sensor reading to torque [s]
  double unknown_delay = 0.0;  ///< additional delay, unknown to the controller [s]
  double bandwidth = 0.0;      ///< of the first-order actuators [Hz]; 0: ideal
  bool perfect_state = false;  ///< give the controller the true state
  bool open_loop = false;      ///< feedforward torques only
  PhysicsOptions physics;
  std::vector<Push> pushes;
  std::uint64_t seed = 1;
  double record_rate = 0.0;  ///< of SimulationResult::samples [Hz]; 0: none
};

}  // namespace prowl
