#include "prowl/trajectory/contact_places.hpp"

#include <numeric>

namespace prowl {
namespace {

std::optional<int> surface_of(const Phase& phase, int contact) {
  for (const PhaseContact& held : phase.contacts) {
    if (held.contact == contact) return held.surface;
  }
  return std::nullopt;
}

std::vector<int> surfaces_around(const ContactPlaces& places, std::size_t phase, std::size_t contact,
                                 std::size_t num_surfaces) {
  std::vector<int> around;
  for (std::size_t p = phase + 1; p-- > 0 && around.empty();) {
    if (const auto surface = places[p][contact].surface) around.push_back(*surface);
  }
  if (places[phase][contact].surface) return around;
  const std::size_t left = around.size();
  for (std::size_t p = phase + 1; p < places.size() && around.size() == left; ++p) {
    if (const auto surface = places[p][contact].surface) around.push_back(*surface);
  }
  if (around.empty()) {
    around.resize(num_surfaces);
    std::iota(around.begin(), around.end(), 0);
  }
  return around;
}

}  // namespace

ContactPlaces contact_places(const MotionProblem& problem, const Trajectory& trajectory, PhaseDynamics& dynamics) {
  const std::size_t num_contacts = problem.robot.contacts().size();
  ContactPlaces places(problem.phases.size(), std::vector<ContactPlace>(num_contacts));
  std::size_t first_node = 0;
  for (std::size_t p = 0; p < places.size(); ++p) {
    const TrajectoryPoint& node = trajectory.nodes[first_node];
    const Eigen::Matrix3Xd points = dynamics[p].contact_points(node.q, node.v).position;
    for (std::size_t c = 0; c < num_contacts; ++c) {
      ContactPlace& place = places[p][c];
      place.surface = surface_of(problem.phases[p], static_cast<int>(c));
      if (!place.surface) continue;
      place.closes = p == 0 || places[p - 1][c].surface != place.surface;
      place.time = place.closes ? node.time : places[p - 1][c].time;
      place.anchor = place.closes ? Eigen::Vector3d(points.col(c)) : places[p - 1][c].anchor;
    }
    first_node += problem.phases[p].intervals + 1;
  }
  for (std::size_t p = 0; p < places.size(); ++p) {
    for (std::size_t c = 0; c < num_contacts; ++c) {
      places[p][c].outside_one_of = surfaces_around(places, p, c, problem.surfaces.size());
    }
  }
  return places;
}

}  // namespace prowl
