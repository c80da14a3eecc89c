#pragma once

#include <vector>

#include "prowl/mesh/mesh.hpp"

namespace prowl {

/// The mesh that refinement starts from if nobody chose one: a node at each goal, equal intervals from goal to goal at
/// kFirstRate for the longest duration of the phase, at least kFewestFirst in a phase. After a goal that leaves a short
/// interval, steps grow to that length by kMostGrowth. `goals` may be in any order.
Mesh first_mesh(const std::vector<Phase>& phases, const std::vector<PhaseFraction>& goals);

/// Enough intervals to find a motion; what its errors ask for, refinement adds.
constexpr double kFirstRate = 10.0;  ///< [1/s]
constexpr int kFewestFirst = 4;      ///< of a phase, on any coarse mesh: a swing must lift off, pass and land

/// Each interval in `pieces` equal ones.
Mesh split(const Mesh& mesh, int pieces);

}  // namespace prowl
