#include "prowl/transcription/node/motion_limit.hpp"

#include <cmath>

#include "prowl/trajectory/state_scale.hpp"

namespace prowl {

namespace {

/// Frequency of a pendulum of the robot's size [1/s].
double rate(const RobotModel& robot) { return std::sqrt(RobotModel::kGravity / robot.size()); }

}  // namespace

MotionLimit limit_of_goal(const RobotModel& robot, const std::string& goal, int i, bool is_velocity) {
  const bool is_joint = i >= 6;
  const bool is_length = is_joint ? robot.joint_is_prismatic()[i - 6] : i < 3;
  return {.kind = LimitKind::goal,
          .subject = goal + ", " + (is_velocity ? "velocity of " : "") + coordinate_name(robot, i),
          .unit = std::string(is_length ? "m" : "rad") + (is_velocity ? "/s" : ""),
          .size = (is_length ? robot.size() : 1.0) * (is_velocity ? rate(robot) : 1.0)};
}

MotionLimit limit_of_standing(const RobotModel& robot, int i) {
  return {.kind = LimitKind::goal,
          .subject = "standing at the end, acceleration of " + coordinate_name(robot, i),
          .unit = i < 3 ? "m/s^2" : "rad/s^2",
          .size = RobotModel::kGravity / (i < 3 ? 1.0 : robot.size())};
}

MotionLimit limit_of_joint(const RobotModel& robot, LimitKind kind, int joint) {
  const bool is_prismatic = robot.joint_is_prismatic()[joint];
  const double length = is_prismatic ? robot.size() : 1.0;
  MotionLimit limit{.kind = kind, .subject = robot.joint_names()[joint], .unit = ""};
  if (kind == LimitKind::torque) {
    limit.unit = is_prismatic ? "N" : "N m";
    limit.size = robot.weight() * (is_prismatic ? 1.0 : robot.size());
  } else {
    limit.unit = std::string(is_prismatic ? "m" : "rad") + (kind == LimitKind::joint_velocity ? "/s" : "");
    limit.size = length * (kind == LimitKind::joint_velocity ? rate(robot) : 1.0);
  }
  return limit;
}

}  // namespace prowl
