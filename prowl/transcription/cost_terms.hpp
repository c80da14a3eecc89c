#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "prowl/motion/motion_problem.hpp"
#include "prowl/trajectory/trajectory.hpp"

namespace prowl {

inline constexpr const char* kTerminalCost = "terminal_cost.";  ///< prefix of the keys of the terminal cost

inline constexpr const char* kOwnTerm = "term.";  ///< of the costs of the user's terms

/// One term of the cost of a motion.
struct CostTerm {
  std::string key;       ///< of the task file: "torque", "terminal_cost.base_position"
  Eigen::VectorXd rate;  ///< contribution to the running cost at each node [1/s]; zero for a term of one moment
  double cost = 0.0;     ///< contribution to the cost: integral of `rate` by the trapezoid, or value at that moment
};

/// Cost terms of a motion with a positive weight. Their sum is the cost of the transcription.
std::vector<CostTerm> cost_terms(const MotionProblem& problem, const Trajectory& motion);

}  // namespace prowl
