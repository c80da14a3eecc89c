#include "prowl/feasibility/reach_check.hpp"

#include <fmt/format.h>

#include "prowl/dynamics/body_bounds.hpp"
#include "prowl/feasibility/prescribed_places.hpp"
#include "prowl/model/surface.hpp"

namespace prowl {

namespace {

using Eigen::Vector3d;

constexpr double kMargin = 5e-3;  // [m]; above what goals and contacts are allowed to be off by

/// A contact that a phase holds.
struct Held {
  const ContactPoint& contact;
  const Surface& surface;
  ContactReach leg;
  std::string first_joint;
  std::optional<Vector3d> place;
};

std::vector<Held> held_in(const MotionProblem& problem, const ContactSchedule& schedule,
                          const std::vector<std::optional<Vector3d>>& places, int p) {
  std::vector<Held> held;
  const Phase& phase = problem.phases[p];
  for (int i = 0; i < static_cast<int>(phase.contacts.size()); ++i) {
    const PhaseContact& contact = phase.contacts[i];
    const ContactReach leg = contact_reach(problem.robot, contact.contact);
    held.push_back({problem.robot.contacts()[contact.contact], problem.surfaces[contact.surface], leg,
                    leg.first_joint < 0 ? "the base" : problem.robot.joint_names()[leg.first_joint],
                    places[schedule.stance(p, i)]});
  }
  return held;
}

/// Least distance from the root of its leg to where the contact has to be [m].
double least_distance(const Held& held, const BoundaryCondition& condition) {
  const PointBounds root = point_bounds(condition, held.leg.root);
  if (held.place) return root.distance(*held.place);
  if (root.lower != root.upper) return 0.0;
  const Vector3d nearest =
      held.surface.at(nearest_in_patch(held.surface, held.surface.coordinates(root.lower)), held.contact.radius);
  return root.distance(nearest);
}

}  // namespace

std::vector<std::string> contacts_out_of_reach(const MotionProblem& problem, const ContactSchedule& schedule) {
  const auto places = prescribed_places(problem, schedule);
  std::vector<std::string> reasons;
  for (int p = 0; p < static_cast<int>(problem.phases.size()); ++p) {
    const std::string& phase = problem.phases[p].name;
    const std::vector<Held> held = held_in(problem, schedule, places, p);
    for (const BoundaryCondition& condition : problem.boundary_conditions) {
      if (!is_during(condition, p)) continue;
      for (const Held& one : held) {
        const double distance = least_distance(one, condition);
        if (!(distance > one.leg.length + kMargin)) continue;
        reasons.push_back(
            fmt::format("{}, phase '{}': contact {} is out of reach: {:.3g} m or more from {}, where its leg "
                        "begins, which is {:.3g} m long",
                        condition.name, phase, one.contact.name, distance, one.first_joint, one.leg.length));
      }
    }
    for (std::size_t i = 0; i < held.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (!held[i].place || !held[j].place) continue;
        const double distance = (*held[i].place - *held[j].place).norm();
        const double span = held[i].leg.length + held[j].leg.length + (held[i].leg.root - held[j].leg.root).norm();
        if (!(distance > span + kMargin)) continue;
        reasons.push_back(fmt::format("phase '{}': contacts {} and {} are {:.3g} m apart, and their legs span {:.3g} m",
                                      phase, held[j].contact.name, held[i].contact.name, distance, span));
      }
    }
  }
  return reasons;
}

}  // namespace prowl
