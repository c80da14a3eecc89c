#pragma once

#include <vector>

#include "prowl/diagnosis/adjustable_parameter.hpp"
#include "prowl/transcription/node/motion_limit.hpp"

namespace prowl {

// Parameters of the limits of joints; kinds: LimitKind torque, joint_velocity, joint_position.

/// A joint's limit [N m or N, rad/s or m/s]; of joint_position the width of the range [rad or m].
double value_of_limit(const RobotModel& robot, LimitKind kind, int joint);

/// Joints whose limit can change; not velocity limits of joints with torque_over_velocity, which ends there.
std::vector<int> turnable_joints(const RobotModel& robot, LimitKind kind);

/// Turns the limits of these turnable_joints (at least one) together. Refers to the problem, which must outlive it.
AdjustableParameter joint_parameter(const MotionProblem& problem, LimitKind kind, const std::vector<int>& joints);

/// One per kind, for all its turnable joints.
std::vector<AdjustableParameter> joint_parameters(const MotionProblem& problem);

}  // namespace prowl
