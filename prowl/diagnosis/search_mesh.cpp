#include "prowl/diagnosis/search_mesh.hpp"

#include "prowl/mesh/mesh_levels.hpp"

namespace prowl {

Mesh search_mesh(const DiscreteProblem& discrete) {
  constexpr int kIntervals = 20;
  const int all = discrete.mesh.num_intervals();
  if (all <= kIntervals) return discrete.mesh;
  return coarsened(discrete.problem, discrete.mesh, [all](int intervals) { return intervals * kIntervals / all; });
}

}  // namespace prowl
