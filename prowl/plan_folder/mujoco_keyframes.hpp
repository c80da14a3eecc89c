#pragma once

#include <string>

#include "prowl/motion/motion_problem.hpp"
#include "prowl/trajectory/trajectory.hpp"

namespace prowl {

/// An MJCF file that includes `model_file` (mujoco_xml()) and contains one keyframe per point of the motion, named
/// PHASE_INDEX. Numbers have all digits.
std::string mujoco_keyframes_xml(const MotionProblem& problem, const Trajectory& motion, const std::string& model_file);

}  // namespace prowl
