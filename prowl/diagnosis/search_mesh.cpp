#include "prowl/diagnosis/search_mesh.hpp"

#include <algorithm>

#include "prowl/transcription/mesh.hpp"
#include "prowl/transcription/mesh_levels.hpp"
#include "prowl/transcription/remesh.hpp"

namespace prowl {

namespace {

constexpr int kIntervals = 20;
constexpr int kLeastOfPhase = 4;  // what it takes for a swing to leave, pass and land

}  // namespace

MotionProblem on_search_mesh(const MotionProblem& problem) {
  const int all = count_intervals(problem);
  if (all <= kIntervals) return problem;
  const std::vector<int> divisors = interval_divisors(problem);
  std::vector<Steps> steps;
  for (std::size_t p = 0; p < problem.phases.size(); ++p) {
    const Phase& phase = problem.phases[p];
    const int wanted = std::max(phase.intervals * kIntervals / all, kLeastOfPhase);
    const int multiple = divisors[p] * ((wanted + divisors[p] - 1) / divisors[p]);
    steps.push_back(steps_with(phase, std::min(phase.intervals, multiple)));
  }
  return on_mesh(problem, steps);
}

MotionProblem with_steps_of(const MotionProblem& problem, const MotionProblem& other) {
  std::vector<Steps> steps;
  for (const Phase& phase : other.phases) {
    Steps& of_phase = steps.emplace_back();
    for (int i = 0; i < phase.intervals; ++i) of_phase.push_back(phase.step(i, 1.0));
  }
  return on_mesh(problem, steps);
}

}  // namespace prowl
