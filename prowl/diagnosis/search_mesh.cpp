#include "prowl/diagnosis/search_mesh.hpp"

#include "prowl/transcription/mesh_levels.hpp"
#include "prowl/transcription/remesh.hpp"

namespace prowl {

MotionProblem on_search_mesh(const MotionProblem& problem) {
  constexpr int kIntervals = 20;
  const int all = count_intervals(problem);
  if (all <= kIntervals) return problem;
  return coarsened(problem, [all](int intervals) { return intervals * kIntervals / all; });
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
