#include "prowl/feasibility/reach_check.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "prowl/dynamics/body_bounds.hpp"
#include "prowl/dynamics/inverse_kinematics.hpp"
#include "prowl/feasibility/joint_range_check.hpp"
#include "prowl/feasibility/prescribed_footholds.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/model/surface.hpp"

namespace prowl {

namespace {

using Eigen::Vector3d;

constexpr double kReachMargin = 5e-3;  // [m]; above the tolerances of goals and contacts

/// A contact that a phase holds.
struct Held {
  int index;  ///< into RobotModel::contacts()
  const ContactPoint& contact;
  const Surface& surface;
  ContactReach leg;
  std::string first_joint;
  std::optional<Vector3d> foothold;
};

std::vector<Held> held_in(const MotionProblem& problem, const ContactSchedule& schedule,
                          const std::vector<std::optional<Vector3d>>& footholds, int p) {
  std::vector<Held> held;
  const Phase& phase = problem.phases[p];
  for (int i = 0; i < static_cast<int>(phase.contacts.size()); ++i) {
    const PhaseContact& contact = phase.contacts[i];
    const ContactReach leg = contact_reach(problem.robot, contact.contact);
    held.push_back({contact.contact, problem.robot.contacts()[contact.contact], problem.surfaces[contact.surface], leg,
                    leg.first_joint < 0 ? "the base" : problem.robot.joint_names()[leg.first_joint],
                    footholds[schedule.stance(p, i)]});
  }
  return held;
}

/// A contact farther from the root of its leg than the length of the leg.
struct TooFar {
  const Held* held;
  double distance;  ///< at least [m]
  double excess() const { return distance - held->leg.length; }
};

/// Least distance from the root of the leg to the contact's foothold [m].
double least_distance(const Held& held, const BoundaryConstraint& constraint) {
  const PointBounds root = point_bounds(constraint, held.leg.root);
  if (held.foothold) return root.distance(*held.foothold);
  if (root.lower != root.upper) return 0.0;
  const Vector3d nearest =
      held.surface.at(nearest_in_patch(held.surface, held.surface.coordinates(root.lower)), held.contact.radius);
  return root.distance(nearest);
}

/// One line for all of these contacts, with the numbers of the farthest.
std::string too_far_in_words(const std::vector<TooFar>& all, std::size_t held) {
  const auto worst =
      std::ranges::max_element(all, [](const TooFar& a, const TooFar& b) { return a.excess() < b.excess(); });
  const Held& contact = *worst->held;
  const std::string numbers = fmt::format("{:.3g} m or more from {}, the root of its leg of length {:.3g} m",
                                          worst->distance, contact.first_joint, contact.leg.length);
  if (all.size() == 1) return fmt::format("contact {} is out of reach: {}", contact.contact.name, numbers);
  std::string names;
  for (const TooFar& one : all) names += (names.empty() ? "" : ", ") + one.held->contact.name;
  return fmt::format(
      "{} are out of reach, by {:.2g} m or more: {} is {}",
      all.size() == held ? fmt::format("all {} contacts", held) : fmt::format("{} contacts ({})", all.size(), names),
      worst->excess(), contact.contact.name, numbers);
}

/// Contacts that a base of any orientation has to reach together.
struct Group {
  std::vector<const Held*> held;
  double length = 0.0;                             ///< mean of the legs [m]
  Eigen::Vector3d root = Eigen::Vector3d::Zero();  ///< mean of their roots, base frame [m]
  explicit Group(std::vector<const Held*> contacts) : held(std::move(contacts)) {
    for (const Held* one : held) {
      length += one->leg.length / static_cast<double>(held.size());
      root += one->leg.root / static_cast<double>(held.size());
    }
  }
};

/// Least distance from the mean root of the legs to the mean of the footholds [m]; if these are not all known, along
/// the normal of their common surface.
double least_distance(const Group& group, const BoundaryConstraint& constraint) {
  const PointBounds root = point_bounds(constraint, group.root);
  const auto count = static_cast<double>(group.held.size());
  if (std::ranges::all_of(group.held, [](const Held* one) { return one->foothold.has_value(); })) {
    Vector3d mean = Vector3d::Zero();
    for (const Held* one : group.held) mean += *one->foothold / count;
    return root.distance(mean);
  }
  const Surface& surface = group.held.front()->surface;
  if (std::ranges::any_of(group.held, [&](const Held* one) { return &one->surface != &surface; })) return 0.0;
  double height = surface.normal.dot(surface.point);  // of the contacts
  for (const Held* one : group.held) height += one->contact.radius / count;
  return std::max({0.0, root.least_along(surface.normal) - height, root.least_along(-surface.normal) + height});
}

/// The mean distance from root to contact is at least the distance of the means, for any base orientation:
///
///   mean length >= mean |p_i - (p_base + R root_i)| >= |mean p_i - (p_base + R mean root_i)|
///
/// The mean of roots on all sides of the base is near its origin, so the rotation hardly matters.
std::string why_the_group_is_out_of_reach(const std::vector<Held>& held, const BoundaryConstraint& constraint) {
  std::vector<std::vector<const Held*>> groups(1);
  for (const Held& one : held) groups.front().push_back(&one);
  for (std::size_t i = 0; i < held.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) groups.push_back({&held[j], &held[i]});
  }
  for (std::vector<const Held*>& contacts : groups) {
    if (contacts.size() < 2) continue;
    const Group group(std::move(contacts));
    const double distance = least_distance(group, constraint);
    if (!(distance > group.length + kReachMargin)) continue;
    std::string names;
    for (const Held* one : group.held) names += (names.empty() ? "" : ", ") + one->contact.name;
    return fmt::format(
        "contacts {} are out of reach for any base orientation: on average {:.3g} m or more from the roots of their "
        "legs of length {:.3g} m",
        names, distance, group.length);
  }
  return "";
}

/// Legs that do not reach within the limits of their joints, where the condition fixes the base and the place of the
/// contact is known; with the numbers of the farthest.
std::string too_far_for_the_joints(const MotionProblem& problem, const std::vector<Held>& held,
                                   const BoundaryConstraint& constraint) {
  const auto bound = constraint.configuration_lower.head<6>();
  if (bound != constraint.configuration_upper.head<6>()) return "";
  Eigen::VectorXd tangent = Eigen::VectorXd::Zero(problem.robot.nv());
  tangent.head<6>() = bound;
  const Eigen::VectorXd q = integrate(constraint.q_ref, tangent);
  std::vector<std::string> names;
  double farthest = 0.0;
  for (const Held& one : held) {
    if (!one.foothold) continue;
    const ContactTarget target{one.index, *one.foothold};
    if (inverse_kinematics(problem.robot, q, {target}).residual <= kReachMargin) continue;
    const Vector3d from_base = base_rotation(q).transpose() * (*one.foothold - base_position(q));
    const double distance = least_distance_within_limits(problem.robot, one.index, from_base, kReachMargin);
    if (distance == 0.0) continue;
    names.push_back(one.contact.name);
    farthest = std::max(farthest, distance);
  }
  if (names.empty()) return "";
  return fmt::format("{} out of reach within the limits of the joints, by {:.2g} m or more",
                     names.size() == 1 ? fmt::format("contact {} is", names.front())
                                       : fmt::format("contacts {} are", fmt::join(names, ", ")),
                     farthest);
}

}  // namespace

std::vector<std::string> contacts_out_of_reach(const MotionProblem& problem, const ContactSchedule& schedule) {
  const auto footholds = prescribed_footholds(problem, schedule);
  std::vector<std::string> reasons;
  for (int p = 0; p < static_cast<int>(problem.phases.size()); ++p) {
    const std::string& phase = problem.phases[p].name;
    const std::vector<Held> held = held_in(problem, schedule, footholds, p);
    for (const BoundaryConstraint& constraint : problem.boundary_constraints) {
      if (!is_during(constraint, p)) continue;
      std::vector<TooFar> too_far;
      for (const Held& one : held) {
        const double distance = least_distance(one, constraint);
        if (distance > one.leg.length + kReachMargin) too_far.push_back({&one, distance});
      }
      std::string reason =
          too_far.empty() ? why_the_group_is_out_of_reach(held, constraint) : too_far_in_words(too_far, held.size());
      if (reason.empty()) reason = too_far_for_the_joints(problem, held, constraint);
      if (!reason.empty()) reasons.push_back(fmt::format("{}, phase '{}': {}", constraint.name, phase, reason));
    }
    for (std::size_t i = 0; i < held.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (!held[i].foothold || !held[j].foothold) continue;
        const double distance = (*held[i].foothold - *held[j].foothold).norm();
        const double span = held[i].leg.length + held[j].leg.length + (held[i].leg.root - held[j].leg.root).norm();
        if (!(distance > span + kReachMargin)) continue;
        reasons.push_back(fmt::format("phase '{}': contacts {} and {} are {:.3g} m apart, but their legs span {:.3g} m",
                                      phase, held[j].contact.name, held[i].contact.name, distance, span));
      }
    }
  }
  return reasons;
}

}  // namespace prowl
