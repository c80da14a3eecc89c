#pragma once

#include <array>

#include "prowl/model/robot_model.hpp"

namespace prowl {

/// Sizes of the disturbances that a robust motion withstands. Each value is uniform between minus and plus its size,
/// each axis and body by itself. docs/robust.md.
struct Disturbances {
  double base_position = 0.0;  ///< of the start [m]
  double base_angle = 0.0;     ///< likewise [rad]
  double base_velocity = 0.0;  ///< likewise [m/s]
  double base_rate = 0.0;      ///< likewise [rad/s]
  double mass = 0.0;           ///< share of mass and inertia of each body [-]
  double center = 0.0;         ///< of the mass of the base [m]
  double friction = 0.0;       ///< share of the friction coefficients that may be missing [-]
  double push = 0.0;  ///< change of the base's velocity that one push gives the whole mass, at its worst time [m/s]
  double push_duration = 0.1;      ///< [s]
  double ground = 0.0;             ///< of the height of the ground under each foot, at two standard deviations [m]
  double estimate_position = 0.0;  ///< of the estimate of the base, constant [m]
  double estimate_angle = 0.0;     ///< likewise [rad]
};

/// Keys of the sizes in task files and plan.json, in their order there.
struct DisturbanceKey {
  const char* name;
  double Disturbances::* size;
  int since;  ///< schema version of plan.json that has it
};
inline constexpr std::array kDisturbanceKeys{DisturbanceKey{"base_position_m", &Disturbances::base_position, 7},
                                             DisturbanceKey{"base_angle_rad", &Disturbances::base_angle, 7},
                                             DisturbanceKey{"base_velocity_mps", &Disturbances::base_velocity, 7},
                                             DisturbanceKey{"base_rate_radps", &Disturbances::base_rate, 7},
                                             DisturbanceKey{"mass", &Disturbances::mass, 7},
                                             DisturbanceKey{"center_m", &Disturbances::center, 7},
                                             DisturbanceKey{"friction", &Disturbances::friction, 7},
                                             DisturbanceKey{"push_mps", &Disturbances::push, 7},
                                             DisturbanceKey{"push_s", &Disturbances::push_duration, 7},
                                             DisturbanceKey{"ground_m", &Disturbances::ground, 8},
                                             DisturbanceKey{"estimate_position_m", &Disturbances::estimate_position, 9},
                                             DisturbanceKey{"estimate_angle_rad", &Disturbances::estimate_angle, 9}};

/// What `prowl sweep` draws for a robot that stands 0.58 m high. For others lengths scale with the height, velocities
/// with its root: docs/simulation.md#cases-of-a-sweep. Ground: 5 mm, and 2 degrees 40 cm away, at two standard
/// deviations. Estimate: the bias of the accelerometer is taken for a tilt, of 0.007 rad at one standard deviation, and
/// moves the base over its feet.
inline constexpr Disturbances kSweptDisturbances{.base_position = 0.01,
                                                 .base_angle = 0.02,
                                                 .base_velocity = 0.05,
                                                 .base_rate = 0.1,
                                                 .mass = 0.1,
                                                 .center = 0.02,
                                                 .friction = 0.2,
                                                 .push = 0.12,
                                                 .ground = 0.017,
                                                 .estimate_position = 0.007,
                                                 .estimate_angle = 0.012};

/// Standing height of the robot over that height.
double height_share(const RobotModel& robot);

/// kSweptDisturbances, scaled to the robot.
Disturbances default_disturbances(const RobotModel& robot);

}  // namespace prowl
