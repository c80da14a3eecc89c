#pragma once

#include "prowl/mesh/discrete_problem.hpp"
#include "prowl/trajectory/trajectory.hpp"

namespace prowl {

/// A motion with the phases of the problem, at the nodes of its mesh, which may be another one than the motion has:
/// each node gets the point at the same fraction of its phase. A phase of another duration than the problem allows is
/// stretched or compressed to what it allows: rates with the inverse of the time, accelerations with its square,
/// torques and forces as they are.
///
/// What the problem asks for otherwise (start, goals, limits) is not looked at: the result is a point to start a solver
/// from. Throws InputError if the motion is of another robot (sizes) or has other phases than the problem (number).
Trajectory resample(const Trajectory& motion, const DiscreteProblem& discrete);

}  // namespace prowl
