#pragma once

#include <string>
#include <vector>

#include "prowl/mesh/discrete_problem.hpp"
#include "prowl/nlp/nlp_solver.hpp"
#include "prowl/trajectory/trajectory.hpp"

namespace prowl {

/// Why there is no motion that solves the problem, each reason a line in the words of the task: phase, goal, contact or
/// surface, by how much. Only what is proven, from lengths, friction and time: a problem that has a solution gives
/// none. Empty says nothing: most of what is infeasible is for the solver to find out. Takes milliseconds.
std::vector<std::string> proofs_of_infeasibility(const MotionProblem& problem, const ContactSchedule& schedule);

/// What may be the matter with a problem that a solver did not solve, likewise in lines: at the first and the last node
/// of each phase and at goals, in the posture that the initial guess has there,
/// - singular postures at the start of phases (postures_that_lose_rank);
/// - contacts that inverse kinematics did not bring to their places;
/// - where the robot could not stand still: the weight is not over the contacts, too little friction, torque of joints.
/// Neither needs to be the reason: another posture may do, and a motion need not stop there. Solves a small linear
/// program for each.
std::vector<std::string> doubts(const DiscreteProblem& discrete, const Trajectory& guess, const NlpSolver& solver);

}  // namespace prowl
