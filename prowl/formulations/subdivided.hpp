#pragma once

#include "prowl/motion/motion_problem.hpp"

namespace prowl {

/// The same problem with each interval of its mesh in so many equal parts; goals stay at their times.
MotionProblem subdivided(MotionProblem problem, int parts);

}  // namespace prowl
