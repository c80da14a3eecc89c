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

  void record_place(const PhaseContact& held, const ContactPlace& place) {
    const Surface& surface = problem_.surfaces[held.surface];
    const ContactPoint& contact = problem_.robot.contacts()[held.contact];
    if (held.place) {
      const Eigen::Vector3d wanted = *held.place + contact.radius * surface.normal;
      place_.record((place.anchor - wanted).norm(), place.time, contact.name);
    }
    if (!place.closes) return;
    gap_.record(std::abs(surface.distance(place.anchor) - contact.radius), place.time, contact.name);
    if (surface.patch.empty()) return;
    outside_.record(distance_from_patch(surface, surface.coordinates(place.anchor)), place.time, contact.name);
  }

  void record_load(const PhaseContact& held, const TrajectoryPoint& last, const Eigen::VectorXd& force) {
    const double normal = problem_.surfaces[held.surface].normal.dot(force.segment<3>(3 * held.contact));
    load_.record(std::abs(normal), last.time, problem_.robot.contacts()[held.contact].name);
  }

  std::vector<CertificateCheck> checks() const {
    std::vector<CertificateCheck> checks;
    for (const WorstCase* check : {&gap_, &outside_, &place_, &load_}) check->append_to(checks);
    return checks;
  }

 private:
  const MotionProblem& problem_;
  WorstCase gap_{"contact gap at closing", "m", Limits::contact_gap};
  WorstCase outside_{"contact outside its patch", "m", Limits::contact_gap};
  WorstCase place_{"contact away from its place", "m", Limits::contact_gap};
  WorstCase load_;
};

}  // namespace

std::vector<CertificateCheck> contact_event_checks(const DiscreteProblem& discrete, const Trajectory& trajectory,
                                                   const ContactPlaces& places, PhaseDynamics& dynamics) {
  const MotionProblem& problem = discrete.problem;
  EventChecks events(problem);
  for (std::size_t p = 0; p < problem.phases.size(); ++p) {
    const TrajectoryPoint& last = trajectory.nodes[discrete.mesh.last_node(static_cast<int>(p))];
    const Eigen::VectorXd force = true_motion(last, dynamics[p]).force;
    for (const PhaseContact& held : problem.phases[p].contacts) {
      const ContactPlace& place = places[p][held.contact];
      events.record_place(held, place);
      if (place.opens) events.record_load(held, last, force);
    }
  }
  return events.checks();
}

}  // namespace prowl
