#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "prowl/motion/motion_problem.hpp"
#include "prowl/trajectory/trajectory.hpp"

namespace prowl {

inline constexpr const char* kTerminalCost = "terminal_cost.";  ///< begins the keys of the terminal cost

/// One term of the cost of a motion.
struct CostTerm {
  std::string key;       ///< of the task file: "torque"; "terminal_cost.base_position" for one of the terminal cost
  Eigen::VectorXd rate;  ///< its part of the running cost at each node [1/s]; zero for a terminal term
  double cost = 0.0;     ///< its part of the cost: the trapezoid of `rate`, or the value at the last node
};

/// The cost of a motion, term by term: their sum is that of the transcription. Terms without a weight are left out.
std::vector<CostTerm> cost_terms(const MotionProblem& problem, const Trajectory& motion);

}  // namespace prowl
