#include "prowl/transcription/mesh.hpp"

#include <algorithm>
#include <cassert>

namespace prowl {

int Mesh::index(NodeRef ref) const {
  const auto found = std::find_if(nodes.begin(), nodes.end(), [&](const MeshNode& candidate) {
    return candidate.phase == ref.phase && candidate.node == ref.node;
  });
  assert(found != nodes.end());
  return static_cast<int>(found - nodes.begin());
}

Mesh make_mesh(const MotionProblem& problem) {
  Mesh mesh;
  double phase_start = 0.0;
  for (std::size_t p = 0; p < problem.phases.size(); ++p) {
    const Phase& phase = problem.phases[p];
    const double duration = phase.duration.is_fixed() ? phase.duration.min
                                                      : 0.5 * (phase.duration.min + phase.duration.max);
    const double h = duration / phase.intervals;
    for (int k = 0; k <= phase.intervals; ++k) {
      // From the whole duration, not by adding steps: the last node falls on the end of the phase exactly.
      mesh.nodes.push_back({.phase = static_cast<int>(p),
                            .node = k,
                            .time = phase_start + duration * k / phase.intervals,
                            .h_in = k > 0 ? h : 0.0,
                            .h_out = k < phase.intervals ? h : 0.0});
    }
    phase_start = mesh.nodes.back().time;
  }
  return mesh;
}

}  // namespace prowl
