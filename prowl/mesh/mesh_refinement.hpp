#pragma once

#include <vector>

#include "prowl/mesh/mesh.hpp"

namespace prowl {

/// A mesh that suits a motion on `mesh`; `parts` contains error over tolerance of each interval, for errors that fall
/// with the fourth power of the step. An interval with more than two thirds of its tolerance is split into as many
/// equal ones as it needs, at most four. No step is more than four times as long as the one before it in its phase.
Mesh refined(const Mesh& mesh, const std::vector<double>& parts);

}  // namespace prowl
