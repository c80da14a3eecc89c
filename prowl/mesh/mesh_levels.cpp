#include "prowl/mesh/mesh_levels.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>

#include "prowl/mesh/first_mesh.hpp"

namespace prowl {

namespace {

constexpr int kCoarser = 4;

/// A mesh up to this size is solved directly: a coarser one takes more time than its start saves (docs/solvers.md).
constexpr int kSmallMesh = 48;

}  // namespace

std::vector<int> interval_divisors(const MotionProblem& problem, const Mesh& mesh) {
  std::vector<int> divisors(mesh.phases.size(), 1);
  for (const PhaseFraction& moment : node_moments(problem)) {
    const PhaseMesh& phase = mesh.phases[moment.phase];
    const auto node = phase.node_at(moment.fraction);
    assert(node);
    int& divisor = divisors[moment.phase];
    divisor = std::lcm(divisor, phase.intervals() / std::gcd(phase.intervals(), *node));
  }
  return divisors;
}

Mesh coarsened(const MotionProblem& problem, const Mesh& mesh, const std::function<int(int)>& wanted) {
  const std::vector<int> divisors = interval_divisors(problem, mesh);
  Mesh coarse;
  for (std::size_t p = 0; p < mesh.phases.size(); ++p) {
    const int intervals = mesh.phases[p].intervals();
    const int least = std::max(wanted(intervals), kFewestFirst);
    const int multiple = divisors[p] * ((least + divisors[p] - 1) / divisors[p]);
    coarse.phases.push_back(mesh.phases[p].with_intervals(std::min(intervals, multiple)));
  }
  return coarse;
}

std::vector<Mesh> mesh_levels(const MotionProblem& problem, const Mesh& mesh) {
  std::vector<Mesh> levels{mesh};
  while (levels.back().num_intervals() > kSmallMesh) {
    const auto a_part = [](int intervals) { return (intervals + kCoarser - 1) / kCoarser; };
    Mesh coarse = coarsened(problem, levels.back(), a_part);
    if (2 * coarse.num_intervals() > levels.back().num_intervals()) break;
    levels.push_back(std::move(coarse));
  }
  std::ranges::reverse(levels);
  return levels;
}

}  // namespace prowl
