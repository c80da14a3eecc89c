#pragma once

#include <vector>

#include "prowl/diagnosis/change.hpp"
#include "prowl/transcription/node/motion_limit.hpp"

namespace prowl {

// Knobs of the limits of joints; kinds: LimitKind torque, joint_velocity, joint_position.

/// A joint's limit [N m or N, rad/s or m/s]; of joint_position the width of the range [rad or m].
double value_of_limit(const RobotModel& robot, LimitKind kind, int joint);

/// Joints whose limit can be another: not the velocity where the torque over it is known up to the limit only.
std::vector<int> turnable_joints(const RobotModel& robot, LimitKind kind);

/// The limits of these joints, one or more of turnable_joints, together. Refers to the problem, which must outlive it.
Knob joint_knob(const MotionProblem& problem, LimitKind kind, const std::vector<int>& joints);

/// One of each kind, for all its turnable joints.
std::vector<Knob> joint_knobs(const MotionProblem& problem);

}  // namespace prowl
