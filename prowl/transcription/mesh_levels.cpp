#include "prowl/transcription/mesh_levels.hpp"

#include <algorithm>

#include "prowl/transcription/mesh.hpp"
#include "prowl/transcription/remesh.hpp"

namespace prowl {

namespace {

constexpr int kCoarser = 4;
constexpr int kLeastIntervals = 4;  // what it takes for a swing to leave, pass and land

/// A mesh this small is solved at once: a start from a coarser one saves fewer iterations than that one takes
/// (docs/solvers.md).
constexpr int kSmallMesh = 48;

}  // namespace

int count_intervals(const MotionProblem& problem) {
  int count = 0;
  for (const Phase& phase : problem.phases) count += phase.intervals;
  return count;
}

MotionProblem coarsened(const MotionProblem& problem, const std::function<int(int)>& wanted) {
  const std::vector<int> divisors = interval_divisors(problem);
  std::vector<Steps> steps;
  for (std::size_t p = 0; p < problem.phases.size(); ++p) {
    const int intervals = problem.phases[p].intervals;
    const int least = std::max(wanted(intervals), kLeastIntervals);
    const int multiple = divisors[p] * ((least + divisors[p] - 1) / divisors[p]);
    steps.push_back(steps_with(problem.phases[p], std::min(intervals, multiple)));
  }
  return on_mesh(problem, steps);
}

std::vector<MotionProblem> mesh_levels(const MotionProblem& problem) {
  std::vector<MotionProblem> levels{problem};
  while (count_intervals(levels.back()) > kSmallMesh) {
    MotionProblem coarse =
        coarsened(levels.back(), [](int intervals) { return (intervals + kCoarser - 1) / kCoarser; });
    if (2 * count_intervals(coarse) > count_intervals(levels.back())) break;
    levels.push_back(std::move(coarse));
  }
  std::ranges::reverse(levels);
  return levels;
}

}  // namespace prowl
