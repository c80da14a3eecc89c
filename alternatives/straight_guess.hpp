#pragma once

#include "prowl/mesh/discrete_problem.hpp"
#include "prowl/trajectory/trajectory.hpp"

namespace prowl {

/// The guess of somebody who knows no more than where the robot starts and where it is to go, to compare solvers from:
/// - q on straight lines between the postures of the start and of each goal (contacts there at their places, by inverse
///   kinematics; between the goals they slide);
/// - v = 0 and a = 0;
/// - tau and forces of standing still in the start posture, on the contacts of the phase.
/// initial_guess() is much nearer to a solution.
Trajectory straight_guess(const DiscreteProblem& discrete);

}  // namespace prowl
