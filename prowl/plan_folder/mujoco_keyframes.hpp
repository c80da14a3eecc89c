#pragma once

#include <string>

#include "prowl/motion/motion_problem.hpp"
#include "prowl/trajectory/trajectory.hpp"

namespace prowl {

/// The MJCF text `model` with one keyframe per point of the motion, named PHASE_INDEX. Numbers have all digits.
std::string add_mujoco_keyframes(const std::string& model, const MotionProblem& problem, const Trajectory& motion);

/// The keyframes alone, as an MJCF file that includes `model_file` (mujoco_xml()).
std::string mujoco_keyframes_xml(const MotionProblem& problem, const Trajectory& motion, const std::string& model_file);

}  // namespace prowl
