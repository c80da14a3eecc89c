#include "prowl/tracking/reference_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "prowl/error.hpp"

namespace prowl {
std::vector<ReferencePhase> reference_grid(const MotionProblem& problem, const Trajectory& trajectory, double step) {
  std::vector<ReferencePhase> grid;
  const std::vector<TrajectoryPoint>& nodes = trajectory.nodes;
  for (auto begin = nodes.begin(); begin != nodes.end();) {
    const auto end = std::find_if(begin, nodes.end(), [&](const auto& node) { return node.phase != begin->phase; });
    const Phase& phase = problem.phases[begin->phase];
    const double start = begin->time, duration = std::prev(end)->time - start;
    if (!(duration > 0.0)) throw InputError(fmt::format("phase \"{}\" has no duration: no gains for it", phase.name));
    constexpr double kRounding = 1e-9;  // a duration of ten steps gives ten, not eleven
    const int intervals = std::max(1, static_cast<int>(std::ceil(duration / step - kRounding)));

    ReferencePhase& sampled = grid.emplace_back();
    sampled.name = phase.name;
    sampled.contacts = contact_indices(phase.contacts);
    for (int i = 0; i < intervals; ++i) {
      sampled.samples.push_back(sample(trajectory, start + duration * i / intervals));
    }
    sampled.samples.push_back(*std::prev(end));
    begin = end;
  }
  return grid;
}

}  // namespace prowl
