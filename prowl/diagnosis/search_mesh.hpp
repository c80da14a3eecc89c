#pragma once

#include "prowl/mesh/discrete_problem.hpp"

namespace prowl {

/// A mesh of about 20 intervals, at least 4 per phase: just fine enough to find a motion, and cheap to solve many
/// times. Goals keep their nodes. Returns a mesh of at most 20 intervals unchanged.
Mesh search_mesh(const DiscreteProblem& discrete);

}  // namespace prowl
