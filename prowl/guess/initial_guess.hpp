#pragma once

#include "prowl/mesh/discrete_problem.hpp"
#include "prowl/trajectory/trajectory.hpp"

namespace prowl {

/// A motion to start the solver from, from the task alone:
/// - the base moves smoothly through the start and all prescribed poses;
/// - contacts follow ContactPath, and joints follow them by inverse kinematics (or take the nearest posture found);
/// - v and a are differences of q; tau and forces are those of the motion, of least norm.
/// Boundary constraints and the robot's limits hold exactly, dynamics only approximately. Always finite.
Trajectory initial_guess(const DiscreteProblem& discrete);

}  // namespace prowl
