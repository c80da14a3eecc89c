#pragma once

#include <string>

#include "prowl/model/robot_model.hpp"

namespace prowl {

/// Something of the moving robot that a term reads. World frame, SI units; velocities are those of v.
struct Quantity {
  enum class Kind {
    position,                 ///< of the origin of a frame [m], 3
    orientation,              ///< of a frame: its axes x, y, z one after the other, 9
    velocity,                 ///< of the origin of a frame [m/s], 3
    orientation_rate,         ///< rates of the axes of a frame [1/s], 9
    center_of_mass,           ///< of the robot [m], 3
    center_of_mass_velocity,  ///< [m/s], 3
    angular_momentum,         ///< of the robot about its centre of mass [N m s], 3
    joints,                   ///< positions of all joints [rad, m], nu
    joint_rates,              ///< [rad/s, m/s], nu
    torques,                  ///< of all joints, on the links [N m, N], nu
    force,                    ///< of the ground on a contact [N], zero while it is open, 3
    time,                     ///< since the start of the motion [s], 1; needs fixed durations
  };
  Kind kind = Kind::position;
  std::string name =
      {};  ///< of the first four kinds: a link of the URDF, or "base"; of `force`: a contact of the robot
};

inline bool is_rate(Quantity::Kind kind) {
  return kind == Quantity::Kind::velocity || kind == Quantity::Kind::orientation_rate ||
         kind == Quantity::Kind::center_of_mass_velocity || kind == Quantity::Kind::angular_momentum ||
         kind == Quantity::Kind::joint_rates;
}

inline bool is_load(Quantity::Kind kind) { return kind == Quantity::Kind::torques || kind == Quantity::Kind::force; }

inline bool is_of_joints(Quantity::Kind kind) {
  return kind == Quantity::Kind::joints || kind == Quantity::Kind::joint_rates || kind == Quantity::Kind::torques;
}

/// Of all bodies together.
inline bool is_of_mass(Quantity::Kind kind) {
  return kind >= Quantity::Kind::center_of_mass && kind <= Quantity::Kind::angular_momentum;
}

inline bool is_of_frame(Quantity::Kind kind) { return kind <= Quantity::Kind::orientation_rate; }

/// Names of the kinds in Python, in their order.
inline constexpr const char* kQuantityNames[] = {
    "position",         "orientation", "velocity",    "orientation_rate", "center_of_mass", "center_of_mass_velocity",
    "angular_momentum", "joints",      "joint_rates", "torques",          "force",          "time"};

/// Number of its entries.
inline int size_of(Quantity::Kind kind, const RobotModel& robot) {
  if (is_of_joints(kind)) return robot.nu();
  if (kind == Quantity::Kind::time) return 1;
  return kind == Quantity::Kind::orientation || kind == Quantity::Kind::orientation_rate ? 9 : 3;
}

}  // namespace prowl
