#include "prowl/trajectory/phase_span.hpp"

#include <algorithm>

namespace prowl {

std::optional<PhaseSpan> phase_span(const Trajectory& trajectory, std::size_t phase) {
  const std::vector<TrajectoryPoint>& nodes = trajectory.nodes;
  const auto is_of_phase = [phase](const TrajectoryPoint& node) { return node.phase == static_cast<int>(phase); };
  const auto first = std::find_if(nodes.begin(), nodes.end(), is_of_phase);
  if (first == nodes.end()) return std::nullopt;
  return PhaseSpan{first->time, std::find_if(nodes.rbegin(), nodes.rend(), is_of_phase)->time};
}

}  // namespace prowl
