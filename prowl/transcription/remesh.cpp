#include "prowl/transcription/remesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "prowl/error.hpp"

namespace prowl {
namespace {

constexpr double kRounding = 1e-9;  // of a phase

/// The node at this part of a phase, in [0, 1].
int node_at(const Phase& phase, double part, const std::string& goal) {
  double at = 0.0;
  for (int k = 0; k <= phase.intervals; ++k) {
    if (std::abs(at - part) <= kRounding) return k;
    if (k < phase.intervals) at += phase.step(k, 1.0);
  }
  throw InputError(fmt::format("{}: no node of the mesh is at {:.6g} of phase '{}'", goal, part, phase.name));
}

}  // namespace

Steps steps_with(const Phase& phase, int intervals) {
  Steps steps;
  const auto place = [&](int j) {  // of node j in the phase, of which it is a part
    const int before = static_cast<int>(static_cast<long>(j) * phase.intervals / intervals);
    const double rest = static_cast<double>(j) * phase.intervals / intervals - before;
    return phase.node_time(before, 1.0) + (before < phase.intervals ? rest * phase.step(before, 1.0) : 0.0);
  };
  for (int j = 0; j < intervals; ++j) steps.push_back(phase.shares.empty() ? 1.0 : place(j + 1) - place(j));
  return steps;
}

void set_steps(Phase& phase, const Steps& steps) {
  phase.intervals = static_cast<int>(steps.size());
  phase.shares.clear();
  const auto [shortest, longest] = std::ranges::minmax(steps);
  if (longest - shortest <= kRounding * longest) return;
  const double sum = std::accumulate(steps.begin(), steps.end(), 0.0);
  constexpr double kIsOne = 1e-12;
  if (std::abs(sum - 1.0) < kIsOne) {  // shares already, kept to the last bit
    phase.shares = steps;
    return;
  }
  for (const double step : steps) phase.shares.push_back(step / sum);
}

MotionProblem on_mesh(MotionProblem problem, const std::vector<Steps>& steps) {
  const std::vector<Phase> before = problem.phases;
  for (std::size_t p = 0; p < problem.phases.size(); ++p) set_steps(problem.phases[p], steps[p]);
  for (BoundaryCondition& condition : problem.boundary_conditions) {
    const auto p = static_cast<std::size_t>(condition.at.phase);
    condition.at.node = node_at(problem.phases[p], before[p].node_time(condition.at.node, 1.0), condition.name);
  }
  return problem;
}

}  // namespace prowl
