#pragma once

#include "prowl/mesh/discrete_problem.hpp"
#include "prowl/trajectory/trajectory.hpp"

namespace prowl {

/// A motion to start the solver from, made from the task alone:
/// - the base goes smoothly through the start and all that boundary conditions prescribe of its pose;
/// - held contacts are at their places, those in the air go from one to the next (ContactPath); joints follow by
/// inverse
///   kinematics (the nearest posture where that finds none);
/// - v and a are differences of q, tau and forces those of the motion, of least norm.
/// Boundary conditions and the robot's limits hold exactly, dynamics only approximately. Always finite.
Trajectory initial_guess(const DiscreteProblem& discrete);

}  // namespace prowl
