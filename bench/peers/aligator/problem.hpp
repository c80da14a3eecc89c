#pragma once

#include <aligator/core/traj-opt-problem.hpp>
#include <nlohmann/json.hpp>
#include <vector>

namespace peer {

using Problem = aligator::TrajOptProblemTpl<double>;
using Vectors = std::vector<Eigen::VectorXd>;

/// A task on a mesh as Aligator's problem, with all limits as constraints, and where its solver starts.
struct ShootingProblem {
  Problem problem;
  Vectors states, inputs;  ///< guess: the start at every node, and the torques that hold it there [m, rad, N m]
};

/// From the document that bench/peers/aligator_solver.py writes. Throws nlohmann::json::exception for another.
ShootingProblem read_problem(const nlohmann::json& document);

}  // namespace peer
