#include "prowl/transcription/mesh.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>

namespace prowl {

int Mesh::index(NodeRef ref) const {
  const auto found = std::find_if(nodes.begin(), nodes.end(), [&](const MeshNode& candidate) {
    return candidate.phase == ref.phase && candidate.node == ref.node;
  });
  assert(found != nodes.end());
  return static_cast<int>(found - nodes.begin());
}

std::vector<int> interval_divisors(const MotionProblem& problem) {
  std::vector<int> divisors(problem.phases.size(), 1);
  for (const BoundaryCondition& condition : problem.boundary_conditions) {
    const auto phase = static_cast<std::size_t>(condition.at.phase);
    const int intervals = problem.phases[phase].intervals;
    divisors[phase] = std::lcm(divisors[phase], intervals / std::gcd(intervals, condition.at.node));
  }
  return divisors;
}

Mesh make_mesh(const MotionProblem& problem) {
  Mesh mesh;
  double phase_start = 0.0;
  for (std::size_t p = 0; p < problem.phases.size(); ++p) {
    const Phase& phase = problem.phases[p];
    const double duration =
        phase.duration.is_fixed() ? phase.duration.min : 0.5 * (phase.duration.min + phase.duration.max);
    for (int k = 0; k <= phase.intervals; ++k) {
      mesh.nodes.push_back({.phase = static_cast<int>(p),
                            .node = k,
                            .time = phase_start + phase.node_time(k, duration),
                            .h_in = k > 0 ? phase.step(k - 1, duration) : 0.0,
                            .h_out = k < phase.intervals ? phase.step(k, duration) : 0.0});
    }
    phase_start = mesh.nodes.back().time;
  }
  return mesh;
}

}  // namespace prowl
