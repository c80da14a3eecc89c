#include "prowl/certificate/contact_events.hpp"

#include <cmath>

#include "prowl/certificate/true_motion.hpp"
#include "prowl/certificate/worst_case.hpp"
#include "prowl/model/surface.hpp"

namespace prowl {
namespace {

using Limits = CertificateLimits;

class EventChecks {
 public:
  explicit EventChecks(const MotionProblem& problem)
      : problem_(problem), load_("force before opening", "N", Limits::force_over_weight * problem.robot.weight()) {}

  void record_landing(const PhaseContact& held, const ContactState& state) {
    const Surface& surface = problem_.surfaces[held.surface];
    const ContactPoint& contact = problem_.robot.contacts()[held.contact];
    if (held.foothold) {
      const Eigen::Vector3d wanted = *held.foothold + contact.radius * surface.normal;
      foothold_.record((state.anchor - wanted).norm(), state.time, contact.name);
    }
    if (!state.closes) return;
    gap_.record(std::abs(surface.distance(state.anchor) - contact.radius), state.time, contact.name);
    if (surface.patch.empty()) return;
    outside_.record(distance_from_patch(surface, surface.coordinates(state.anchor)), state.time, contact.name);
  }

  void record_load(const PhaseContact& held, const TrajectoryPoint& last, const Eigen::VectorXd& force) {
    const double normal = problem_.surfaces[held.surface].normal.dot(force.segment<3>(3 * held.contact));
    load_.record(std::abs(normal), last.time, problem_.robot.contacts()[held.contact].name);
  }

  std::vector<CertificateCheck> checks() const {
    std::vector<CertificateCheck> checks;
    for (const WorstCase* check : {&gap_, &outside_, &foothold_, &load_}) check->append_to(checks);
    return checks;
  }

 private:
  const MotionProblem& problem_;
  WorstCase gap_{"contact gap at closing", "m", Limits::contact_gap};
  WorstCase outside_{"contact outside its patch", "m", Limits::contact_gap};
  WorstCase foothold_{"contact away from its place", "m", Limits::contact_gap};
  WorstCase load_;
};

}  // namespace

std::vector<CertificateCheck> contact_event_checks(const DiscreteProblem& discrete, const Trajectory& trajectory,
                                                   const ContactStates& states, PhaseDynamics& dynamics) {
  const MotionProblem& problem = discrete.problem;
  EventChecks events(problem);
  for (std::size_t p = 0; p < problem.phases.size(); ++p) {
    const TrajectoryPoint& last = trajectory.nodes[discrete.mesh.last_node(static_cast<int>(p))];
    const Eigen::VectorXd force = true_motion(last, dynamics[p]).force;
    for (const PhaseContact& held : problem.phases[p].contacts) {
      const ContactState& state = states[p][held.contact];
      events.record_landing(held, state);
      if (state.opens) events.record_load(held, last, force);
    }
  }
  return events.checks();
}

}  // namespace prowl
