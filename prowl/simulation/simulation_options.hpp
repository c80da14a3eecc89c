#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "prowl/simulation/physics.hpp"

namespace prowl {

/// Standard deviations of one sensor sample, white noise. Besides it every sensor has a constant bias, drawn once from
/// a normal distribution of the same standard deviation.
struct SensorNoise {
  double encoder = 1e-3;        ///< [rad]
  double gyro = 2e-3;           ///< [rad/s]
  double accelerometer = 0.05;  ///< [m/s^2]
};

/// A force on the base's centre of mass, constant while it lasts.
struct Push {
  Eigen::Vector3d impulse = Eigen::Vector3d::Zero();  ///< world frame [N s]
  double time = 0.0;                                  ///< when it begins [s]
  double duration = 0.1;                              ///< [s]
};

/// When a simulation counts as a success; `[simulation]` of the task file.
struct SuccessCriteria {
  double position = 0.02;  ///< of the base in rest at the end, from where the plan ends [m]
  double angle = 0.035;    ///< the same [rad]
  double slip = 0.02;      ///< of any standing foot [m]
  double rest = 1.5;       ///< time to go on standing after the plan's end [s]
};

constexpr double kRecordRate = 200.0;  ///< what front ends record unless told otherwise [Hz]

struct SimulationOptions {
  double control_rate = 1000.0;  ///< [Hz]
  SensorNoise noise;
  double noise_scale = 1.0;    ///< on all of it
  double delay = 2e-3;         ///< from the sample of the sensors to the torque [s]
  double unknown_delay = 0.0;  ///< on top of it, which the controller does not count on [s]
  double bandwidth = 0.0;      ///< of the actuators, first order [Hz]; 0: they follow at once
  bool perfect_state = false;  ///< the controller sees the true state, not the estimated one
  bool open_loop = false;      ///< feedforward torques only
  PhysicsOptions physics;
  std::vector<Push> pushes;
  std::uint64_t seed = 1;
  double record_rate = 0.0;  ///< of SimulationResult::samples [Hz]; 0: none
};

}  // namespace prowl
