#include "prowl/mesh/resample.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "prowl/error.hpp"

namespace prowl {

namespace {

/// The motion of each phase by itself. Throws InputError unless they fit the problem.
std::vector<Trajectory> motions_of_phases(const Trajectory& motion, const MotionProblem& problem) {
  const std::size_t num_phases = problem.phases.size();
  std::vector<Trajectory> phases;
  for (const TrajectoryPoint& node : motion.nodes) {
    if (phases.empty() || phases.back().nodes.back().phase != node.phase) {
      phases.emplace_back();
      phases.back().interpolation = motion.interpolation;
    }
    phases.back().nodes.push_back(node);
  }
  if (phases.size() != num_phases) {
    throw InputError(fmt::format("the motion to start from has {} phases, the task {}", phases.size(), num_phases));
  }
  for (std::size_t p = 0; p < num_phases; ++p) {
    if (phases[p].nodes.size() < 2) {
      throw InputError(fmt::format("the motion to start from has no interval in phase {}", p + 1));
    }
    for (const TrajectoryPoint& node : phases[p].nodes) {
      if (node.q.size() == problem.robot.nq() && node.v.size() == problem.robot.nv() &&
          node.a.size() == problem.robot.nv() && node.tau.size() == problem.robot.nu() &&
          node.force.size() == 3 * static_cast<Eigen::Index>(problem.robot.contacts().size())) {
        continue;
      }
      throw InputError("the motion to start from is of another robot");
    }
  }
  return phases;
}

}  // namespace

Trajectory resample(const Trajectory& motion, const DiscreteProblem& discrete) {
  const std::vector<Trajectory> phases = motions_of_phases(motion, discrete.problem);
  Trajectory result;
  double phase_start = 0.0;
  for (int k = 0; k < discrete.num_nodes(); ++k) {
    const MeshNode& node = discrete.nodes[k];
    const Duration& allowed = discrete.phase_of(k).duration;
    const PhaseMesh& mesh = discrete.phase_mesh_of(k);
    const Trajectory& old = phases[node.phase];
    const double fraction = mesh.node_time(node.node, 1.0);
    const double old_start = old.nodes.front().time, old_duration = old.duration() - old_start;
    const double duration = std::clamp(old_duration, allowed.min, allowed.max);
    TrajectoryPoint point = sample(old, old_start + fraction * old_duration);
    point.v *= old_duration / duration;
    point.a *= old_duration / duration * (old_duration / duration);
    point.time = phase_start + mesh.node_time(node.node, duration);
    if (node.node == mesh.intervals()) phase_start = point.time;
    result.nodes.push_back(std::move(point));
  }
  return result;
}

}  // namespace prowl
