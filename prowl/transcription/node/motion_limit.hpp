#pragma once

#include <string>

#include "prowl/model/robot_model.hpp"

namespace prowl {

/// Limits that a task or robot could change, in contrast to physics.
enum class LimitKind { friction, torque, joint_position, joint_velocity, goal, foothold, clearance, term };

inline const char* to_string(LimitKind kind) {
  constexpr const char* kNames[] = {"friction", "torque", "joint_position", "joint_velocity",
                                    "goal",     "place",  "clearance",      "term"};
  return kNames[static_cast<int>(kind)];
}

/// One such limit of a transcription: a constraint row, or bounds of a variable.
struct MotionLimit {
  LimitKind kind = LimitKind::friction;
  bool is_moment = false;  ///< of a term that holds at one moment
  bool is_row = false;     ///< else a variable
  int index = 0;           ///< row or variable
  int node = 0;            ///< of the mesh
  int phase = 0;
  std::string subject;  ///< contact, joint, or subject of a goal: "goal 1, base z"
  std::string unit;     ///< "N", "N m", "rad", ...
  double si = 1.0;      ///< one unit of the row or variable, in `unit`
  double size = 1.0;    ///< violation that counts as one, in `unit`; from weight and size of the robot
};

/// Limit of a goal on entry i of the configuration tangent or the velocity, 0 <= i < nv. Sets kind,
/// subject, unit and size.
MotionLimit limit_of_goal(const RobotModel& robot, const std::string& goal, int i, bool is_velocity);

/// Limit of a goal, that the base does not accelerate at the end, on entry i of its acceleration, 0 <= i < 6.
MotionLimit limit_of_standing(const RobotModel& robot, int i);

/// Limit of a joint (torque, joint_position, joint_velocity). Sets kind, subject, unit and size.
/// Sizes scale with the robot, not the limit; otherwise overloading a far too weak joint would cost
/// more than overloading a strong one.
MotionLimit limit_of_joint(const RobotModel& robot, LimitKind kind, int joint);

}  // namespace prowl
