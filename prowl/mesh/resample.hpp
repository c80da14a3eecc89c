#pragma once

#include "prowl/mesh/discrete_problem.hpp"
#include "prowl/trajectory/trajectory.hpp"

namespace prowl {

/// Samples a motion at the nodes of the problem's mesh: each node gets the point at the same fraction of its phase. A
/// phase whose duration the problem does not allow is stretched or compressed to the nearest allowed one: rates scale
/// with 1 / time, accelerations with 1 / time², torques and forces stay.
///
/// Ignores start, goals and limits: the result only starts a solver. Throws InputError if sizes (another robot) or the
/// number of phases differ.
Trajectory resample(const Trajectory& motion, const DiscreteProblem& discrete);

}  // namespace prowl
