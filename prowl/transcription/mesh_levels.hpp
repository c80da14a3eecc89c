#pragma once

#include <functional>
#include <vector>

#include "prowl/motion/motion_problem.hpp"

namespace prowl {

int count_intervals(const MotionProblem& problem);

/// Each phase on wanted(its intervals) of them, or more if goals need that for their nodes or it were less than four,
/// but not more than it has.
MotionProblem coarsened(const MotionProblem& problem, const std::function<int(int)>& wanted);

/// The problem on meshes of growing fineness, its own as the last: what is found on one is the guess of the next. Most
/// iterations go to finding the motion and few to refining it, and on a quarter of the intervals they cost a quarter.
/// Each level has a quarter of the intervals of the next, but no phase less than four
/// (if it has them at all), and a node for every goal; a level that would save less than half is left out.
std::vector<MotionProblem> mesh_levels(const MotionProblem& problem);

}  // namespace prowl
