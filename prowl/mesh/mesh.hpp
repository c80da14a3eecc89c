#pragma once

#include <optional>
#include <vector>

#include "prowl/motion/phase.hpp"

namespace prowl {

constexpr int kMostIntervals = 10000;  ///< of a motion; more would be a typing mistake, and gigabytes of memory

/// Largest ratio of a step to the one before it in its phase: the gains of contacts allow no more (node_functions.cpp).
constexpr double kMostGrowth = 4.0;

/// Division of a phase of any duration into mesh intervals. Node k = 0 ... intervals() is the end of interval k - 1.
class PhaseMesh {
 public:
  /// Equal intervals. Throws InputError unless there is at least one.
  explicit PhaseMesh(int intervals = 1);
  /// One interval for each of these lengths, > 0; only their proportions count. Throws InputError.
  explicit PhaseMesh(const std::vector<double>& lengths);

  int intervals() const { return intervals_; }
  bool is_even() const { return shares_.empty(); }
  /// Part of the phase in each interval, 1 in all; empty if all are equal.
  const std::vector<double>& shares() const { return shares_; }
  /// Length of interval i, 0 ... intervals() - 1, of a phase of this duration [s].
  double step(int i, double duration) const;
  /// Time from the start of a phase of this duration to its node k [s]. The last node is exactly at the end.
  double node_time(int k, double duration) const;
  /// The node at this part of the phase, up to rounding; none if there is no node.
  std::optional<int> node_at(double fraction) const;

  /// The same distribution with `count` intervals: in an uneven mesh, node j follows a part j / count of the intervals.
  PhaseMesh with_intervals(int count) const;

  bool operator==(const PhaseMesh&) const = default;

 private:
  int intervals_;
  std::vector<double> shares_;
};

/// The mesh of a motion: intervals of all phases. Its nodes are those of all phases in order; the last node of a phase
/// and the first of the next are two nodes at one time, a phase transition.
struct Mesh {
  std::vector<PhaseMesh> phases;

  int num_intervals() const;
  int num_nodes() const { return num_intervals() + static_cast<int>(phases.size()); }
  /// Index among all nodes of node k of a phase.
  int node(int phase, int k) const;
  int first_node(int phase) const { return node(phase, 0); }
  int last_node(int phase) const { return node(phase, phases[phase].intervals()); }
  bool is_even() const;  ///< within each phase

  bool operator==(const Mesh&) const = default;
};

/// Equal intervals in each phase, at this rate for its longest duration, at least two: a swing keeps its clearance at
/// the nodes inside.
Mesh mesh_with_rate(const std::vector<Phase>& phases, double intervals_per_second);

}  // namespace prowl
