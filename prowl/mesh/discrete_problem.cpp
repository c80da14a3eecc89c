#include "prowl/mesh/discrete_problem.hpp"

#include <fmt/format.h>

#include <utility>

#include "prowl/error.hpp"

namespace prowl {
namespace {

const MotionProblem& valid(const MotionProblem& problem, const Mesh& mesh) {
  validate(problem);
  if (mesh.phases.size() != problem.phases.size()) {
    throw InputError(
        fmt::format("mesh: {} phases are not allowed; the problem has {}", mesh.phases.size(), problem.phases.size()));
  }
  return problem;
}

/// Middle of the range [s].
double nominal_duration(const Duration& duration) {
  return duration.is_fixed() ? duration.min : 0.5 * (duration.min + duration.max);
}

std::vector<MeshNode> mesh_nodes(const std::vector<Phase>& phases, const Mesh& mesh) {
  std::vector<MeshNode> nodes;
  double phase_start = 0.0;
  for (int p = 0; p < static_cast<int>(phases.size()); ++p) {
    const PhaseMesh& cut = mesh.phases[p];
    const double duration = nominal_duration(phases[p].duration);
    for (int k = 0; k <= cut.intervals(); ++k) {
      nodes.push_back({.phase = p,
                       .node = k,
                       .time = phase_start + cut.node_time(k, duration),
                       .h_in = k > 0 ? cut.step(k - 1, duration) : 0.0,
                       .h_out = k < cut.intervals() ? cut.step(k, duration) : 0.0});
    }
    phase_start = nodes.back().time;
  }
  return nodes;
}

}  // namespace

std::vector<int> find_boundary_nodes(const MotionProblem& problem, const Mesh& mesh) {
  const auto find = [&](const std::string& name, PhaseFraction at) {
    if (const auto node = mesh.phases[at.phase].node_at(at.fraction)) return mesh.node(at.phase, *node);
    throw InputError(fmt::format("{}: no node of the mesh is at {:.6g} of phase '{}'", name, at.fraction,
                                 problem.phases[at.phase].name));
  };
  std::vector<int> nodes;
  for (const BoundaryConstraint& constraint : problem.boundary_constraints) {
    nodes.push_back(find(constraint.name, constraint.at));
  }
  for (const TermUse& use : problem.terms) {
    for (const PhaseFraction& end : {use.from, use.to}) find("term '" + use.name + "'", end);
  }
  return nodes;
}

DiscreteProblem::DiscreteProblem(MotionProblem motion_problem, Mesh problem_mesh)
    : problem(std::move(motion_problem)),
      mesh(std::move(problem_mesh)),
      schedule(valid(problem, mesh)),
      nodes(mesh_nodes(problem.phases, mesh)),
      boundary_nodes(find_boundary_nodes(problem, mesh)) {}

std::string DiscreteProblem::describe_node(int k) const {
  return fmt::format("phase {} '{}', node {}", nodes[k].phase + 1, phase_of(k).name, nodes[k].node);
}

std::string DiscreteProblem::describe_moment(int k) const {
  return fmt::format("{}, t = {:.3f} s", describe_node(k), nodes[k].time);
}

}  // namespace prowl
