#include "prowl/mesh/mesh_refinement.hpp"

#include <algorithm>
#include <cmath>

namespace prowl {
namespace {

constexpr double kMargin = 1.5;           // on an error: the next motion differs, with errors elsewhere
constexpr int kMost = 4;                  // pieces of an interval: an error predicts little far from its step
constexpr double kOrder = 4.0;            // of the error in the step
constexpr double kLengthRounding = 1e-9;  // of a phase

int pieces_for(double part) {
  return static_cast<int>(std::clamp<double>(std::ceil(std::pow(kMargin * part, 1.0 / kOrder)), 1, kMost));
}

PhaseMesh refined(const PhaseMesh& phase, const double* parts) {
  std::vector<double> lengths;
  for (int i = 0; i < phase.intervals(); ++i) {
    const double length = phase.step(i, 1.0);
    int pieces = pieces_for(parts[i]);
    if (!lengths.empty())
      pieces = std::max(pieces, static_cast<int>(std::ceil(length / (kMostGrowth * lengths.back()) - kLengthRounding)));
    lengths.insert(lengths.end(), static_cast<std::size_t>(pieces), length / pieces);
  }
  return PhaseMesh(lengths);
}

}  // namespace

Mesh refined(const Mesh& mesh, const std::vector<double>& parts) {
  Mesh finer;
  const double* of_phase = parts.data();
  for (const PhaseMesh& phase : mesh.phases) {
    finer.phases.push_back(refined(phase, of_phase));
    of_phase += phase.intervals();
  }
  return finer;
}

}  // namespace prowl
