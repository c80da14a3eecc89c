#pragma once

#include <string>

#include "prowl/model/robot_model.hpp"

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
  std::string subject;  ///< contact, joint, or what a goal is about: "goal 1, base z"
  std::string unit;     ///< "N", "N m", "rad", ...
  double si = 1.0;      ///< of one of the row or variable, in that unit
  double size = 1.0;    ///< what counts as a violation of one, in that unit: of the robot, mostly: weight, size, both
};

/// What a goal says of entry i of a configuration's tangent, or of a velocity, 0 <= i < nv: kind, subject, unit and
/// size.
MotionLimit limit_of_goal(const RobotModel& robot, const std::string& goal, int i, bool is_velocity);

/// A robot's limit on a joint (torque, joint_position, joint_velocity): kind, subject, unit and size. Sizes are those
/// of the robot, not of the limit: else a joint that is by far too weak would cost more than a strong one that is
/// overloaded in its place.
MotionLimit limit_of_joint(const RobotModel& robot, LimitKind kind, int joint);

}  // namespace prowl
