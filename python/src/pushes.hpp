#pragma once

#include <array>
#include <utility>
#include <vector>

#include "prowl/simulation/simulation.hpp"

namespace prowl::python {

using PushArgument = std::pair<double, std::array<double, 3>>;  ///< time [s], impulse [N s] in world axes

/// Pushes of the base, each so long [s].
inline std::vector<Push> pushes_of(const std::vector<PushArgument>& arguments, double duration) {
  std::vector<Push> pushes;
  for (const auto& [time, impulse] : arguments)
    pushes.push_back({{impulse[0], impulse[1], impulse[2]}, time, duration});
  return pushes;
}

}  // namespace prowl::python
