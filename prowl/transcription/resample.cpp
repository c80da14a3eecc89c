#include "prowl/transcription/resample.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "prowl/error.hpp"

namespace prowl {

namespace {

using Nodes = std::span<const TrajectoryPoint>;

/// The nodes of each phase. Throws InputError unless they fit the problem.
std::vector<Nodes> nodes_of_phases(const Trajectory& motion, const MotionProblem& problem) {
  const std::size_t num_phases = problem.phases.size();
  std::vector<Nodes> phases;
  for (auto first = motion.nodes.begin(); first != motion.nodes.end();) {
    const auto last = std::find_if(first, motion.nodes.end(), [&](const auto& node) { return node.phase != first->phase; });
    phases.emplace_back(first, last);
    first = last;
  }
  if (phases.size() != num_phases) {
    throw InputError(fmt::format("the motion to start from has {} phases, the task {}", phases.size(), num_phases));
  }
  for (std::size_t p = 0; p < num_phases; ++p) {
    if (phases[p].size() < 2) throw InputError(fmt::format("the motion to start from has no interval in phase {}", p + 1));
    for (const TrajectoryPoint& node : phases[p]) {
      if (node.q.size() == problem.robot.nq() && node.v.size() == problem.robot.nv() && node.a.size() == problem.robot.nv() &&
          node.tau.size() == problem.robot.nu() &&
          node.force.size() == 3 * static_cast<Eigen::Index>(problem.robot.contacts().size())) {
        continue;
      }
      throw InputError("the motion to start from is of another robot");
    }
  }
  return phases;
}

/// The point at `fraction` of a phase.
TrajectoryPoint at_fraction(Nodes phase, double fraction) {
  const double t = phase.front().time + fraction * (phase.back().time - phase.front().time);
  const auto after = std::upper_bound(phase.begin() + 1, phase.end() - 1, t,
                                      [](double time, const TrajectoryPoint& node) { return time < node.time; });
  const TrajectoryPoint& left = *(after - 1);
  return interpolate(left, *after, std::clamp(t - left.time, 0.0, after->time - left.time));
}

}  // namespace

Trajectory resample(const Trajectory& motion, const MotionProblem& problem, const Mesh& mesh) {
  const std::vector<Nodes> phases = nodes_of_phases(motion, problem);
  Trajectory result;
  double phase_start = 0.0;
  for (const MeshNode& node : mesh.nodes) {
    const Phase& phase = problem.phases[static_cast<std::size_t>(node.phase)];
    const Nodes nodes = phases[static_cast<std::size_t>(node.phase)];
    const double fraction = static_cast<double>(node.node) / phase.intervals;
    const double old_duration = nodes.back().time - nodes.front().time;
    const double duration = std::clamp(old_duration, phase.duration.min, phase.duration.max);
    TrajectoryPoint point = at_fraction(nodes, fraction);
    point.v *= old_duration / duration;
    point.a *= old_duration / duration * (old_duration / duration);
    point.time = phase_start + fraction * duration;
    if (node.node == phase.intervals) phase_start = point.time;
    result.nodes.push_back(std::move(point));
  }
  return result;
}

}  // namespace prowl
