#pragma once

#include <vector>

#include "prowl/trajectory/constrained_dynamics_oracle.hpp"
#include "prowl/trajectory/trajectory.hpp"

namespace prowl {

/// One interval of a trajectory's mesh: two neighbouring nodes of one phase.
struct MeshInterval {
  const TrajectoryPoint& left;
  const TrajectoryPoint& right;
  double step() const { return right.time - left.time; }
};

inline std::vector<MeshInterval> mesh_intervals(const Trajectory& trajectory) {
  std::vector<MeshInterval> intervals;
  for (std::size_t k = 0; k + 1 < trajectory.nodes.size(); ++k) {
    const TrajectoryPoint& left = trajectory.nodes[k];
    const TrajectoryPoint& right = trajectory.nodes[k + 1];
    if (left.phase == right.phase) intervals.push_back({left, right});
  }
  return intervals;
}

/// The true dynamics of each phase, by its index.
using PhaseDynamics = std::vector<ConstrainedDynamicsOracle>;

}  // namespace prowl
