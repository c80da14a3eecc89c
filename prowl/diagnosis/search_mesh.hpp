#pragma once

#include "prowl/mesh/discrete_problem.hpp"

namespace prowl {

/// A mesh of about 20 intervals, 4 or more a phase: as coarse as tells whether there is a motion at all, and cheap to
/// solve again and again. Goals keep their nodes. The problem's own if it has no more.
Mesh search_mesh(const DiscreteProblem& discrete);

}  // namespace prowl
