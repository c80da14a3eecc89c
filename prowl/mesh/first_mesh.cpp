#include "prowl/mesh/first_mesh.hpp"

#include <algorithm>
#include <cmath>

namespace prowl {
namespace {

constexpr double kRounding = 1e-9;  // of a phase: 0.3 s at 10/s are 3 intervals, not 4

/// Appends the steps of a part of this length, each at most `longest`.
void add_part(double length, double longest, std::vector<double>& steps) {
  const auto equal = [&] { return std::max(1.0, std::ceil(length / longest - kRounding)); };
  while (!steps.empty() && length / equal() > kMostGrowth * steps.back() * (1.0 + kRounding)) {
    steps.push_back(kMostGrowth * steps.back());
    length -= steps.back();
  }
  const double count = equal();
  steps.insert(steps.end(), static_cast<std::size_t>(count), length / count);
}

}  // namespace

Mesh first_mesh(const std::vector<Phase>& phases, const std::vector<PhaseFraction>& goals) {
  Mesh mesh;
  for (int p = 0; p < static_cast<int>(phases.size()); ++p) {
    std::vector<double> ends = {1.0};
    for (const PhaseFraction& goal : goals) {
      if (goal.phase == p && goal.fraction > kRounding) ends.push_back(goal.fraction);
    }
    std::ranges::sort(ends);
    const auto is_same = [](double before, double end) { return end - before <= kRounding; };
    ends.erase(std::unique(ends.begin(), ends.end(), is_same), ends.end());
    const double longest = std::min(1.0 / kFewestFirst, 1.0 / (kFirstRate * phases[p].duration.max));
    std::vector<double> steps;
    double begin = 0.0;
    for (const double end : ends) {
      add_part(end - begin, longest, steps);
      begin = end;
    }
    mesh.phases.emplace_back(steps);
  }
  return mesh;
}

Mesh split(const Mesh& mesh, int pieces) {
  Mesh finer;
  for (const PhaseMesh& phase : mesh.phases) {
    if (phase.is_even()) {
      finer.phases.emplace_back(pieces * phase.intervals());
      continue;
    }
    std::vector<double> steps;
    for (const double share : phase.shares())
      steps.insert(steps.end(), static_cast<std::size_t>(pieces), share / pieces);
    finer.phases.emplace_back(steps);
  }
  return finer;
}

}  // namespace prowl
