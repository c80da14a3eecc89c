#pragma once

#include <string>
#include <vector>

#include "prowl/mesh/discrete_problem.hpp"
#include "prowl/trajectory/trajectory.hpp"

namespace prowl {

/// What a solver may start from, the default first: "smooth" (initial_guess) and "straight" (straight_guess).
const std::vector<std::string>& guess_names();

/// Throws InputError that lists the names for any other.
Trajectory make_guess(const std::string& name, const DiscreteProblem& discrete);

}  // namespace prowl
