#pragma once

#include <string>

#include "prowl/motion/motion_problem.hpp"
#include "prowl/tracker/tracker.hpp"
#include "prowl/trajectory/trajectory.hpp"

namespace prowl {

// What the figures of a plan show and only the model tells, as tables (CSV) for whatever draws them. The columns are in
// docs/figures.md. What is no number at a time (a contact that is open) is "nan".

/// J a and −J̇v of every contact [m/s²], world axes, at the nodes and between them no more than `step` [s] apart. Where
/// a contact holds, both are the same but for what the transcription leaves.
std::string contact_acceleration_csv(const MotionProblem& problem, const Trajectory& trajectory, double step);

/// One row of K(t): the 2 nv gains that act on the torque of `joint`, at every sample of the tracker. A switch of
/// contacts has two samples at one time. Throws InputError if the tracker is of another robot.
std::string gains_csv(const RobotModel& robot, const Tracker& tracker, int joint);

/// Least and largest torque of every joint at the planned position and velocity, all limits together, at the nodes.
std::string torque_limits_csv(const RobotModel& robot, const Trajectory& trajectory);

/// The limit over the position of all joints that have one, at rest, from end to end of their table: joint, position,
/// limit.
std::string limit_curves_csv(const RobotModel& robot);

/// Joint and leg, one row a joint. A leg is what moves contacts, from its first joint at the base on; legs count from 0
/// in the order of their contacts, joints that move none (arms, head) come last.
std::string legs_csv(const RobotModel& robot);

/// Index of a joint by name; throws InputError that names the nearest.
int joint_index(const RobotModel& robot, const std::string& name);
/// The first joint with a limit over its position (a knee of HyQ); without one, the last joint of the first leg.
int default_gains_joint(const RobotModel& robot);

}  // namespace prowl
