#include "prowl/certificate/contact_places.hpp"

namespace prowl {
namespace {

std::optional<int> surface_of(const Phase& phase, int contact) {
  for (const PhaseContact& held : phase.contacts) {
    if (held.contact == contact) return held.surface;
  }
  return std::nullopt;
}

/// Sets `opens` and `swings` from the other phases.
void look_around(ContactPlaces& places, std::size_t contact) {
  const auto is_closed = [&](std::size_t phase) { return places[phase][contact].surface.has_value(); };
  for (std::size_t p = 0; p < places.size(); ++p) {
    bool before = false, after = false;
    for (std::size_t other = 0; other < p; ++other) before = before || is_closed(other);
    for (std::size_t other = p + 1; other < places.size(); ++other) after = after || is_closed(other);
    places[p][contact].swings = !is_closed(p) && before && after;
    places[p][contact].opens = is_closed(p) && p + 1 < places.size() && !is_closed(p + 1);
  }
}

}  // namespace

ContactPlaces contact_places(const DiscreteProblem& discrete, const Trajectory& trajectory, PhaseDynamics& dynamics) {
  const MotionProblem& problem = discrete.problem;
  const std::size_t num_contacts = problem.robot.contacts().size();
  ContactPlaces places(problem.phases.size(), std::vector<ContactPlace>(num_contacts));
  for (std::size_t p = 0; p < places.size(); ++p) {
    const TrajectoryPoint& node = trajectory.nodes[discrete.mesh.first_node(static_cast<int>(p))];
    const Eigen::Matrix3Xd points = dynamics[p].contact_points(node.q, node.v).position;
    for (std::size_t c = 0; c < num_contacts; ++c) {
      ContactPlace& place = places[p][c];
      place.surface = surface_of(problem.phases[p], static_cast<int>(c));
      if (!place.surface) continue;
      place.closes = p == 0 || places[p - 1][c].surface != place.surface;
      place.time = place.closes ? node.time : places[p - 1][c].time;
      place.anchor = place.closes ? Eigen::Vector3d(points.col(c)) : places[p - 1][c].anchor;
    }
  }
  for (std::size_t c = 0; c < num_contacts; ++c) look_around(places, c);
  return places;
}

}  // namespace prowl
