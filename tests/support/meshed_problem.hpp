#pragma once

#include <utility>
#include <vector>

#include "prowl/mesh/discrete_problem.hpp"

namespace prowl::test {

/// A problem and its mesh, to be changed before they are prepared.
struct MeshedProblem {
  MotionProblem problem;
  Mesh mesh;
  DiscreteProblem discrete() const { return {problem, mesh}; }
};

/// So many equal intervals in each phase.
inline Mesh even_mesh(const MotionProblem& problem, int intervals) {
  return {std::vector(problem.phases.size(), PhaseMesh(intervals))};
}

/// The problem on such a mesh.
inline DiscreteProblem on_even_mesh(MotionProblem problem, int intervals) {
  Mesh mesh = even_mesh(problem, intervals);
  return {std::move(problem), std::move(mesh)};
}

/// Intervals of each phase.
inline std::vector<int> intervals_of(const Mesh& mesh) {
  std::vector<int> intervals;
  for (const PhaseMesh& phase : mesh.phases) intervals.push_back(phase.intervals());
  return intervals;
}

}  // namespace prowl::test
