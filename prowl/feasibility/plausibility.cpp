#include "prowl/feasibility/plausibility.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "prowl/model/robot_inspection.hpp"

namespace prowl {

namespace {

constexpr double kStickiestSole = 2.0;  // [-]; rubber on dry concrete has about 1, climbing shoes less than 2
constexpr double kTimeToFall = 1.0;     // [s]; a body of 1 m falls over in 0.5 s

/// At the shortest duration of the phase [s].
double longest_interval(const Phase& phase, const PhaseMesh& mesh) {
  double longest = 0.0;
  for (int i = 0; i < mesh.intervals(); ++i) longest = std::max(longest, mesh.step(i, phase.duration.min));
  return longest;
}

}  // namespace

std::vector<std::string> implausibilities(const MotionProblem& problem, const Mesh& mesh) {
  std::vector<std::string> lines = implausible_sizes(problem.robot);
  for (const Surface& surface : problem.surfaces) {
    if (surface.friction <= kStickiestSole) continue;
    lines.push_back(fmt::format("surface '{}' has friction {:g}; rubber on dry concrete has about 1", surface.name,
                                surface.friction));
  }
  for (std::size_t p = 0; p < problem.phases.size(); ++p) {
    const Phase& phase = problem.phases[p];
    const double longest = longest_interval(phase, mesh.phases[p]);
    if (longest <= kTimeToFall) continue;
    lines.push_back(fmt::format(
        "phase '{}' has mesh intervals of {:.3g} s, in which a robot could fall over (durations are in seconds)",
        phase.name, longest));
  }
  return lines;
}

}  // namespace prowl
