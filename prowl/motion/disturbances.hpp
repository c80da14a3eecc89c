#pragma once

#include <array>

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
  double ground = 0.0;         ///< of the height of the ground where a foot lands [m]
};

/// Keys of the sizes in task files and plan.json, in their order there.
struct DisturbanceKey {
  const char* name;
  double Disturbances::* size;
};
inline constexpr std::array kDisturbanceKeys{DisturbanceKey{"base_position_m", &Disturbances::base_position},
                                             DisturbanceKey{"base_angle_rad", &Disturbances::base_angle},
                                             DisturbanceKey{"base_velocity_mps", &Disturbances::base_velocity},
                                             DisturbanceKey{"base_rate_radps", &Disturbances::base_rate},
                                             DisturbanceKey{"mass", &Disturbances::mass},
                                             DisturbanceKey{"center_m", &Disturbances::center},
                                             DisturbanceKey{"friction", &Disturbances::friction},
                                             DisturbanceKey{"push_mps", &Disturbances::push},
                                             DisturbanceKey{"push_s", &Disturbances::push_duration},
                                             DisturbanceKey{"ground_m", &Disturbances::ground}};

/// What `prowl sweep` draws for a robot that stands 0.58 m high. For others lengths scale with the height, velocities
/// with its root: docs/simulation.md#cases-of-a-sweep. Ground: 5 mm, and 2 degrees 40 cm away, at two standard
/// deviations.
inline constexpr Disturbances kSweptDisturbances{.base_position = 0.01,
                                                 .base_angle = 0.02,
                                                 .base_velocity = 0.05,
                                                 .base_rate = 0.1,
                                                 .mass = 0.1,
                                                 .center = 0.02,
                                                 .friction = 0.2,
                                                 .push = 0.12,
                                                 .ground = 0.015};

/// Standing height of the robot over that height.
double height_share(const RobotModel& robot);

/// kSweptDisturbances, scaled to the robot.
Disturbances default_disturbances(const RobotModel& robot);

}  // namespace prowl
