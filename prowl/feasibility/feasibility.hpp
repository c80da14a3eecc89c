#pragma once

#include <string>
#include <vector>

#include "prowl/mesh/discrete_problem.hpp"
#include "prowl/nlp/nlp_solver.hpp"
#include "prowl/trajectory/trajectory.hpp"

namespace prowl {

/// Proofs that no motion solves the problem, one line each in the words of the task: phase, goal, contact or surface,
/// by how much. They follow from lengths, friction and time: a solvable problem gives none. Most infeasible problems
/// give none either, and the solver has to find out. Takes milliseconds; 0.1 s a leg where joint limits decide.
std::vector<std::string> proofs_of_infeasibility(const MotionProblem& problem, const ContactSchedule& schedule);

/// Doubts about a problem that a solver did not solve, one line each, from the postures of the initial guess at the
/// first and last node of each phase and at goals:
/// - singular postures at the start of phases (postures_that_lose_rank);
/// - contacts that inverse kinematics did not put on their footholds;
/// - postures in which the robot cannot stand still: weight not over the contacts, too little friction or torque.
/// A doubt need not be the reason: another posture may work, and a motion need not stop there. Solves a small linear
/// program per posture.
std::vector<std::string> doubts(const DiscreteProblem& discrete, const Trajectory& guess, const NlpSolver& solver);

}  // namespace prowl
