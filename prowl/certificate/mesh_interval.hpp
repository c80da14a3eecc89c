#pragma once

#include <vector>

#include "prowl/certificate/constrained_dynamics_oracle.hpp"
#include "prowl/trajectory/hermite_interval.hpp"
#include "prowl/trajectory/trajectory.hpp"

namespace prowl {

/// One interval of a trajectory's mesh: two neighbouring nodes of one phase.
struct MeshInterval {
  const TrajectoryPoint& left;
  const TrajectoryPoint& right;
  Interpolation interpolation = Interpolation::trapezoid;
  const Eigen::VectorXd* middle_torque = nullptr;  ///< null: torque is linear
  bool ends_phase = false;

  double step() const { return right.time - left.time; }
  bool is_hermite() const { return interpolation == Interpolation::hermite; }
  /// At left.time + s.
  TrajectoryPoint at(double s) const {
    return is_hermite() ? hermite_point(left, right, middle_torque, s) : interpolate(left, right, s);
  }
  /// dq/ds, as interpolated_rate().
  Eigen::VectorXd rate(double s) const {
    return is_hermite() ? hermite_rate(left, right, s) : interpolated_rate(left, right, s);
  }
  Eigen::VectorXd torque(double s) const { return hermite_torque(left, right, middle_torque, s); }
};

inline std::vector<MeshInterval> mesh_intervals(const Trajectory& trajectory) {
  std::vector<MeshInterval> intervals;
  for (std::size_t k = 0; k + 1 < trajectory.nodes.size(); ++k) {
    const TrajectoryPoint& left = trajectory.nodes[k];
    const TrajectoryPoint& right = trajectory.nodes[k + 1];
    if (left.phase != right.phase) continue;
    const bool bent = !trajectory.middle_torques.empty();
    const Eigen::VectorXd* middle = bent ? &trajectory.middle_torques[intervals.size()] : nullptr;
    const bool ends_phase = k + 2 == trajectory.nodes.size() || trajectory.nodes[k + 2].phase != right.phase;
    intervals.push_back({left, right, trajectory.interpolation, middle, ends_phase});
  }
  return intervals;
}

/// The true dynamics of each phase, by its index.
using PhaseDynamics = std::vector<ConstrainedDynamicsOracle>;

}  // namespace prowl
