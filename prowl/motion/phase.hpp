#pragma once

#include <Eigen/Core>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

namespace prowl {

/// A contact of the robot that holds a fixed point of a surface during a phase.
struct PhaseContact {
  int contact = 0;  ///< index into RobotModel::contacts()
  int surface = 0;  ///< index into MotionProblem::surfaces
  /// Where a contact that lands in this phase has to touch, world frame [m]; on the surface. Free where not given.
  std::optional<Eigen::Vector3d> place = {};
};

/// Of each contact its index into RobotModel::contacts().
inline std::vector<int> contact_indices(const std::vector<PhaseContact>& held) {
  std::vector<int> indices;
  for (const PhaseContact& one : held) indices.push_back(one.contact);
  return indices;
}

/// How long a phase lasts [s]: fixed where min == max, else chosen by the optimiser between the two.
struct Duration {
  double min = 0.0;
  double max = 0.0;
  bool is_fixed() const { return min == max; }
};

constexpr int kMostIntervals = 10000;  ///< of a motion; a typing mistake above that, and gigabytes of memory

/// A time with one set of contacts, cut into mesh intervals.
struct Phase {
  std::string name;
  std::vector<PhaseContact> contacts;
  Duration duration;
  int intervals = 1;
  /// What each interval takes of the phase's duration: one an interval, > 0, 1 in all. Empty: all the same.
  std::vector<double> shares = {};

  /// Length of interval i, 0 ... intervals - 1, of a phase that lasts so long [s].
  double step(int i, double lasting) const { return shares.empty() ? lasting / intervals : lasting * shares[i]; }
  /// From the start of a phase that lasts so long to its node k, 0 ... intervals [s]. The last is at the end exactly.
  double node_time(int k, double lasting) const {
    if (k == intervals) return lasting;
    if (shares.empty()) return lasting * k / intervals;
    return lasting * std::accumulate(shares.begin(), shares.begin() + k, 0.0);
  }
};

/// Node of a phase, 0 ... intervals. The last node of a phase and the first of the next are two nodes at one time.
struct NodeRef {
  int phase = 0;
  int node = 0;
  bool operator==(const NodeRef&) const = default;
};

}  // namespace prowl
