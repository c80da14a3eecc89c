#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

namespace prowl {

/// A contact of the robot that holds a fixed point of a surface during a phase.
struct PhaseContact {
  int contact = 0;  ///< index into RobotModel::contacts()
  int surface = 0;  ///< index into MotionProblem::surfaces
  /// Foothold of a contact that lands in this phase: on the surface, world frame [m]. Free if not given.
  std::optional<Eigen::Vector3d> foothold = {};
  bool unloaded = false;  ///< may carry nothing: exempt from MotionProblem::least_load
};

/// Indices into RobotModel::contacts().
inline std::vector<int> contact_indices(const std::vector<PhaseContact>& held) {
  std::vector<int> indices;
  for (const PhaseContact& one : held) indices.push_back(one.contact);
  return indices;
}

/// Duration of a phase [s]: fixed if min == max; otherwise the optimiser chooses between the two.
struct Duration {
  double min = 0.0;
  double max = 0.0;
  bool is_fixed() const { return min == max; }
};

/// A time with one set of contacts.
struct Phase {
  std::string name;
  std::vector<PhaseContact> contacts;
  Duration duration;
};

/// A moment of a motion: the elapsed part of a phase, from 0 (its start) to 1 (its end). The end of a phase and the
/// start of the next are one time.
struct PhaseFraction {
  int phase = 0;
  double fraction = 0.0;
  bool operator==(const PhaseFraction&) const = default;

  static PhaseFraction start_of(int phase) { return {phase, 0.0}; }
  static PhaseFraction end_of(int phase) { return {phase, 1.0}; }
};

}  // namespace prowl
