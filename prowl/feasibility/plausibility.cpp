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

/// "" unless the motion ends at rest above a line, about which no contact gives a moment.
std::string why_nothing_holds_its_end(const MotionProblem& problem) {
  const std::size_t contacts = problem.phases.back().contacts.size();
  if (!ends_at_rest(problem) || can_stand_at_end(problem) || contacts == 0) return "";
  return fmt::format(
      "the motion ends at rest on {}: no torque holds a robot there for long; end on three or more contacts",
      contacts == 1 ? "one point" : "two points");
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
  if (const std::string end = why_nothing_holds_its_end(problem); !end.empty()) lines.push_back(end);
  return lines;
}

}  // namespace prowl
