#pragma once

#include <string>

#include "prowl/plan_folder/motion_samples.hpp"
#include "prowl/plan_folder/plan_folder.hpp"

namespace prowl {

// The texts of docs/exports.md, where frames, units and keys are. Numbers have all digits.

/// The columns of trajectory.csv.
std::string motion_csv(const MotionProblem& problem, const MotionSamples& samples);

/// One row a sample: time_s, phase, and K row by row, "JOINT:COLUMN" with the columns of gain_columns(). Empty if there
/// are no gains.
std::string motion_gains_csv(const RobotModel& robot, const MotionSamples& samples);

/// Everything, with placements of links and contacts by forward kinematics.
std::string motion_json(const PlanRecord& plan, const MotionSamples& samples);

/// motion_json() and what MCAP needs besides: the URDF, and each link's placement in its parent. For the scripts in
/// cli/exports only.
std::string exchange_json(const PlanRecord& plan, const MotionSamples& samples);

/// trajectory_msgs/JointTrajectory of ROS, its fields as keys.
std::string joint_trajectory_json(const RobotModel& robot, const MotionSamples& samples);

/// An MJCF file that includes `model_file` and has one keyframe a sample, named PHASE_INDEX.
std::string mujoco_keyframes_xml(const MotionProblem& problem, const MotionSamples& samples,
                                 const std::string& model_file);

}  // namespace prowl
