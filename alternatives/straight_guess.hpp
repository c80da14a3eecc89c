#pragma once

#include "prowl/mesh/discrete_problem.hpp"
#include "prowl/trajectory/trajectory.hpp"

namespace prowl {

/// A naive initial guess to compare solvers from; initial_guess() is much closer to a solution.
/// - q: straight lines between the postures of start and goals (contacts on their footholds there, by
///   inverse kinematics; sliding in between);
/// - v = 0 and a = 0;
/// - tau and forces: static, in the start posture on the contacts of the phase.
Trajectory straight_guess(const DiscreteProblem& discrete);

}  // namespace prowl
