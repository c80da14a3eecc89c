#include "prowl/mesh/mesh_refinement.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace prowl {
namespace {

using Lengths = std::vector<double>;

constexpr double kMargin = 1.5;  // on an error: the next motion differs, with errors elsewhere
constexpr int kMost = 4;  // pieces of an interval, or intervals in one: an error predicts little far from its step
/// Part of the tolerance: merged intervals should not be split again in the next round.
constexpr double kMergeBelow = 0.25;
constexpr double kLongest = 0.25;         // of a phase, for merged intervals: a swing must lift off, pass and land
constexpr double kLengthRounding = 1e-9;  // of a phase

/// Splits and merges the intervals of one phase.
class PhaseIntervals {
 public:
  PhaseIntervals(const PhaseMesh& phase, const double* parts, std::set<int> goals)
      : phase_(phase), parts_(parts), goals_(std::move(goals)) {}

  PhaseMesh refined() const {
    Lengths lengths;
    for (int i = 0; i < phase_.intervals();) {
      const int pieces = pieces_of(i), end = pieces > 1 ? i + 1 : end_of_run(i);
      add(length(i, end), pieces, lengths);
      i = end;
    }
    return PhaseMesh(lengths);
  }

 private:
  static void add(double length, int pieces, Lengths& lengths) {
    if (!lengths.empty())
      pieces = std::max(pieces, static_cast<int>(std::ceil(length / (kMostGrowth * lengths.back()) - kLengthRounding)));
    lengths.insert(lengths.end(), static_cast<std::size_t>(pieces), length / pieces);
  }

  double length(int first, int end) const { return phase_.node_time(end, 1.0) - phase_.node_time(first, 1.0); }

  int pieces_of(int i) const {
    return static_cast<int>(std::clamp<double>(std::ceil(std::cbrt(kMargin * parts_[i])), 1, kMost));
  }

  /// One past the last interval that merges with `first`.
  int end_of_run(int first) const {
    int end = first + 1;
    while (end < phase_.intervals() && end - first < kMost && !goals_.contains(end) && may_be_one(first, end + 1))
      ++end;
    return end;
  }

  bool may_be_one(int first, int end) const {
    const double joint = length(first, end);
    if (joint > kLongest + kLengthRounding) return false;
    for (int i = first; i < end; ++i) {
      if (parts_[i] * std::pow(joint / length(i, i + 1), 3) > kMergeBelow) return false;
    }
    return true;
  }

  const PhaseMesh& phase_;
  const double* parts_;
  std::set<int> goals_;  ///< nodes
};

}  // namespace

Mesh refined(const MotionProblem& problem, const Mesh& mesh, const std::vector<double>& parts) {
  Mesh finer;
  const double* of_phase = parts.data();
  for (int p = 0; p < static_cast<int>(mesh.phases.size()); ++p) {
    const PhaseMesh& phase = mesh.phases[p];
    std::set<int> goals;
    for (const BoundaryConstraint& constraint : problem.boundary_constraints) {
      if (constraint.at.phase == p) goals.insert(phase.node_at(constraint.at.fraction).value());
    }
    finer.phases.push_back(PhaseIntervals(phase, of_phase, std::move(goals)).refined());
    of_phase += phase.intervals();
  }
  return finer;
}

}  // namespace prowl
