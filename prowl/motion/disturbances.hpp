#pragma once

#include "prowl/model/robot_model.hpp"

namespace prowl {

/// What a robust motion holds under: each value is drawn evenly between minus and plus its size, each axis and body by
/// itself. docs/robust.md.
struct Disturbances {
  double base_position = 0.0;  ///< of the start [m]
  double base_angle = 0.0;     ///< likewise [rad]
  double base_velocity = 0.0;  ///< likewise [m/s]
  double base_rate = 0.0;      ///< likewise [rad/s]
  double mass = 0.0;           ///< share of mass and inertia of each body [-]
  double center = 0.0;         ///< of the mass of the base [m]
  double friction = 0.0;       ///< share of the coefficients that may be missing [-]
  double push = 0.0;  ///< change of the base's velocity that one push gives the whole mass, at its worst time [m/s]
  double push_duration = 0.1;  ///< [s]
};

/// The sizes that `prowl sweep` draws: docs/simulation.md#cases-of-a-sweep.
Disturbances default_disturbances(const RobotModel& robot);

}  // namespace prowl
