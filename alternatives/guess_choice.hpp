#pragma once

#include <string>
#include <vector>

#include "prowl/mesh/discrete_problem.hpp"
#include "prowl/trajectory/trajectory.hpp"

namespace prowl {

/// Initial guesses, the default first: "smooth" (initial_guess) and "straight" (straight_guess).
const std::vector<std::string>& guess_names();

/// Throws InputError with the list of names for any other name.
Trajectory make_guess(const std::string& name, const DiscreteProblem& discrete);

}  // namespace prowl
