#pragma once

#include <vector>

#include "prowl/motion/motion_problem.hpp"

namespace prowl {

/// Steps of the intervals of a phase, > 0; only their proportions count.
using Steps = std::vector<double>;

/// Those of so many intervals of the phase, as fine as before in each part of it. Of an equal mesh they are equal; of
/// an uneven one node j of n falls where j / n of the old intervals are over.
Steps steps_with(const Phase& phase, int intervals);

/// Cuts the phase into such steps. Nodes of goals are not looked at.
void set_steps(Phase& phase, const Steps& steps);

/// The problem with such steps of each phase. Goals stay where they are in their phases. Throws InputError if one has
/// no node there.
MotionProblem on_mesh(MotionProblem problem, const std::vector<Steps>& steps);

}  // namespace prowl
