#include "prowl/certificate/contact_states.hpp"

namespace prowl {
namespace {

std::optional<int> surface_of(const Phase& phase, int contact) {
  for (const PhaseContact& held : phase.contacts) {
    if (held.contact == contact) return held.surface;
  }
  return std::nullopt;
}

/// Sets `opens` and `swings` from the other phases.
void look_around(ContactStates& states, std::size_t contact) {
  const auto is_closed = [&](std::size_t phase) { return states[phase][contact].surface.has_value(); };
  for (std::size_t p = 0; p < states.size(); ++p) {
    bool before = false, after = false;
    for (std::size_t other = 0; other < p; ++other) before = before || is_closed(other);
    for (std::size_t other = p + 1; other < states.size(); ++other) after = after || is_closed(other);
    states[p][contact].swings = !is_closed(p) && before && after;
    states[p][contact].opens = is_closed(p) && p + 1 < states.size() && !is_closed(p + 1);
  }
}

}  // namespace

ContactStates contact_states(const DiscreteProblem& discrete, const Trajectory& trajectory, PhaseDynamics& dynamics) {
  const MotionProblem& problem = discrete.problem;
  const std::size_t num_contacts = problem.robot.contacts().size();
  ContactStates states(problem.phases.size(), std::vector<ContactState>(num_contacts));
  for (std::size_t p = 0; p < states.size(); ++p) {
    const TrajectoryPoint& node = trajectory.nodes[discrete.mesh.first_node(static_cast<int>(p))];
    const Eigen::Matrix3Xd points = dynamics[p].contact_points(node.q, node.v).position;
    for (std::size_t c = 0; c < num_contacts; ++c) {
      ContactState& state = states[p][c];
      state.surface = surface_of(problem.phases[p], static_cast<int>(c));
      if (!state.surface) continue;
      state.closes = p == 0 || states[p - 1][c].surface != state.surface;
      state.time = state.closes ? node.time : states[p - 1][c].time;
      state.anchor = state.closes ? Eigen::Vector3d(points.col(c)) : states[p - 1][c].anchor;
    }
  }
  for (std::size_t c = 0; c < num_contacts; ++c) look_around(states, c);
  return states;
}

}  // namespace prowl
