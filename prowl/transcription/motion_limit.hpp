#pragma once

#include <string>

namespace prowl {

/// What a user asks for or what a robot can do, as opposed to what physics demands: limits that a task might have
/// otherwise.
enum class LimitKind { friction, torque, joint_position, joint_velocity, goal, place, clearance };

inline const char* to_string(LimitKind kind) {
  constexpr const char* kNames[] = {"friction", "torque", "joint_position", "joint_velocity",
                                    "goal",     "place",  "clearance"};
  return kNames[static_cast<int>(kind)];
}

/// One such limit of a transcription: a row of its constraints, or the bounds of one of its variables.
struct MotionLimit {
  LimitKind kind = LimitKind::friction;
  bool is_row = false;  ///< else a variable
  int index = 0;        ///< row or variable
  int node = 0;         ///< of the mesh
  int phase = 0;
  double time = 0.0;    ///< [s]; in phases of free duration that of the initial mesh
  std::string subject;  ///< contact, joint, or what a goal is about: "goal 1, base z"
  std::string unit;     ///< "N", "N m", "rad", ...
  double si = 1.0;      ///< of one of the row or variable, in that unit
  double size = 1.0;    ///< what counts as a violation of one, in that unit: of the robot, mostly: weight, size, both
};

}  // namespace prowl
