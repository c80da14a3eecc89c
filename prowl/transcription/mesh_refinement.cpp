#include "prowl/transcription/mesh_refinement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "prowl/transcription/remesh.hpp"

namespace prowl {
namespace {

using Limits = CertificateLimits;

constexpr double kMargin = 1.5;  // on an error: the next motion is another one, and its errors are elsewhere
constexpr int kMost = 4;         // pieces of an interval, or intervals in one: far from its step an error says little
constexpr double kMergeBelow =
    0.25;                          // of what an error may be: what is merged shall not be split again in the next round
constexpr double kLongest = 0.25;  // of a phase, for merged intervals: a swing has to leave, pass and land
constexpr double kRounding = 1e-9;  // of a phase
constexpr double kMostGrowth =
    4.0;  // of a step over the one before: what the gains of contacts are good for (node_functions.cpp)

double worst(const Certificate& certificate, const char* name) {
  const CertificateCheck* const check = certificate.find(name);
  return check ? check->worst : 0.0;
}

/// Splits and merges the intervals of one phase.
class PhaseIntervals {
 public:
  PhaseIntervals(const Phase& phase, const double* parts, std::set<int> goals)
      : phase_(phase), parts_(parts), goals_(std::move(goals)) {}

  Steps refined() const {
    Steps steps;
    for (int i = 0; i < phase_.intervals;) {
      const int pieces = pieces_of(i), end = pieces > 1 ? i + 1 : end_of_run(i);
      add(length(i, end), pieces, steps);
      i = end;
    }
    return steps;
  }

 private:
  static void add(double length, int pieces, Steps& steps) {
    if (!steps.empty())
      pieces = std::max(pieces, static_cast<int>(std::ceil(length / (kMostGrowth * steps.back()) - kRounding)));
    steps.insert(steps.end(), static_cast<std::size_t>(pieces), length / pieces);
  }

  double length(int first, int end) const { return phase_.node_time(end, 1.0) - phase_.node_time(first, 1.0); }

  int pieces_of(int i) const {
    return static_cast<int>(std::clamp<double>(std::ceil(std::cbrt(kMargin * parts_[i])), 1, kMost));
  }

  /// One after the last interval that goes into one with the first.
  int end_of_run(int first) const {
    int end = first + 1;
    while (end < phase_.intervals && end - first < kMost && !goals_.contains(end) && may_be_one(first, end + 1)) ++end;
    return end;
  }

  bool may_be_one(int first, int end) const {
    const double joint = length(first, end);
    if (joint > kLongest + kRounding) return false;
    for (int i = first; i < end; ++i) {
      if (parts_[i] * std::pow(joint / length(i, i + 1), 3) > kMergeBelow) return false;
    }
    return true;
  }

  const Phase& phase_;
  const double* parts_;
  std::set<int> goals_;  ///< nodes
};

}  // namespace

MeshTolerance mesh_tolerance(Grade grade) {
  if (grade == Grade::certified) {
    return {Limits::integration_error_certified, Limits::second_error_certified, Limits::reintegration_certified};
  }
  return {Limits::integration_error_draft, Limits::second_error_draft, Limits::reintegration_draft};
}

MeshTolerance mesh_tolerance(double reintegration) {
  const MeshTolerance of_grade =
      mesh_tolerance(reintegration <= Limits::reintegration_certified ? Grade::certified : Grade::draft);
  return {reintegration * of_grade.local / of_grade.reintegration, of_grade.second, reintegration};
}

MeshTolerance mesh_errors(const Certificate& certificate) {
  return {worst(certificate, "local integration error"), worst(certificate, "integration error in a second"),
          worst(certificate, "re-integration")};
}

std::vector<double> error_parts(const Certificate& certificate, const MeshTolerance& tolerance) {
  const auto part_of = [&](const IntervalError& of, double local) {
    const double part = std::max(of.error / local, of.reintegration / tolerance.reintegration);
    return std::isfinite(of.error) && std::isfinite(of.reintegration) ? part : std::numeric_limits<double>::infinity();
  };
  const MeshTolerance errors = mesh_errors(certificate);
  // As long as intervals are too coarse by themselves, the sum tells nothing of what is left of it.
  const bool is_for_the_sum =
      errors.local <= tolerance.local && errors.reintegration <= tolerance.reintegration && errors.second > 0.0;
  const double for_the_sum = errors.local * std::pow(tolerance.second / errors.second, 1.5);
  const double local = is_for_the_sum ? std::min(tolerance.local, for_the_sum) : tolerance.local;
  std::vector<double> parts;
  for (const IntervalError& interval : certificate.interval_errors) parts.push_back(part_of(interval, local));
  return parts;
}

MotionProblem refined(const MotionProblem& problem, const std::vector<double>& parts) {
  std::vector<Steps> steps;
  const double* of_phase = parts.data();
  for (int p = 0; p < static_cast<int>(problem.phases.size()); ++p) {
    std::set<int> goals;
    for (const BoundaryCondition& condition : problem.boundary_conditions) {
      if (condition.at.phase == p) goals.insert(condition.at.node);
    }
    const Phase& phase = problem.phases[p];
    steps.push_back(PhaseIntervals(phase, of_phase, std::move(goals)).refined());
    of_phase += phase.intervals;
  }
  return on_mesh(problem, steps);
}

}  // namespace prowl
