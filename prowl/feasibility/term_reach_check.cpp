#include "prowl/feasibility/term_reach_check.hpp"

#include <fmt/format.h>

#include <limits>
#include <optional>
#include <utility>

#include "prowl/dynamics/body_bounds.hpp"
#include "prowl/feasibility/prescribed_footholds.hpp"
#include "prowl/model/robot_frame.hpp"
#include "prowl/terms/selected_entries.hpp"

namespace prowl {

namespace {

using Eigen::Vector3d;

/// A point of the robot that must be in a box of the world, from one moment to another.
struct Place {
  std::string name;
  BodyPoint point;
  Vector3d lower, upper;  ///< [m]; infinite where free
  PhaseFraction from, to;
};

/// A limit of a link's position in the world.
std::optional<Place> place_of(const RobotModel& robot, const TermUse& use) {
  const auto* const term = dynamic_cast<const SelectedEntries*>(use.term.get());
  if (!term || use.is_cost() || term->reads().front().kind != Quantity::Kind::position) return std::nullopt;
  const RobotFrame frame = robot_frame(robot, term->reads().front().name);
  constexpr double kFree = std::numeric_limits<double>::infinity();
  Place place{.name = fmt::format("term '{}'", use.name),
              .point = {.body = frame.body, .in_body = frame.placement.translation()},
              .lower = Vector3d::Constant(-kFree),
              .upper = Vector3d::Constant(kFree),
              .from = use.from,
              .to = use.to};
  for (int row = 0; row < term->num_rows(); ++row) {
    place.lower(term->entries()[row]) = use.lower(row);
    place.upper(term->entries()[row]) = use.upper(row);
  }
  return place;
}

std::vector<Place> places_of_contacts_and_goals(const MotionProblem& problem, const ContactSchedule& schedule) {
  std::vector<Place> places;
  const auto footholds = prescribed_footholds(problem, schedule);
  RigidBodyTerms terms(problem.robot);
  for (int p = 0; p < static_cast<int>(problem.phases.size()); ++p) {
    const std::vector<PhaseContact>& held = problem.phases[p].contacts;
    for (int i = 0; i < static_cast<int>(held.size()); ++i) {
      const std::optional<Vector3d>& foothold = footholds[schedule.stance(p, i)];
      if (!foothold) continue;
      const int contact = held[i].contact;
      places.push_back(
          {fmt::format("contact {} in phase '{}'", problem.robot.contacts()[contact].name, problem.phases[p].name),
           terms.contact_point(contact), *foothold, *foothold, PhaseFraction::start_of(p), PhaseFraction::end_of(p)});
    }
  }
  for (const BoundaryConstraint& constraint : problem.boundary_constraints) {
    const PointBounds base = point_bounds(constraint, Vector3d::Zero());
    places.push_back(
        {"the base at the " + constraint.name, BodyPoint(), base.lower, base.upper, constraint.at, constraint.at});
  }
  return places;
}

bool is_at_or_before(const PhaseFraction& a, const PhaseFraction& b) {
  return a.phase + a.fraction <= b.phase + b.fraction;
}

double least_distance(const Place& a, const Place& b) {
  return (a.lower - b.upper).cwiseMax(b.lower - a.upper).cwiseMax(0.0).norm();
}

/// Why both cannot be; none if that is not certain.
std::optional<std::string> why_apart(const MotionProblem& problem, const Place& a, const Place& b) {
  if (!is_at_or_before(a.from, b.to) || !is_at_or_before(b.from, a.to)) return std::nullopt;
  const double distance = least_distance(a, b) - 2.0 * problem.goal_tolerance.position;
  const double reach = largest_distance(problem.robot, a.point, b.point);
  if (!(distance > reach)) return std::nullopt;
  return fmt::format(
      "{} and {} exclude each other: they are {:.3g} m or more apart, the links between them reach {:.3g} m", a.name,
      b.name, distance, reach);
}

}  // namespace

std::vector<std::string> terms_out_of_reach(const MotionProblem& problem, const ContactSchedule& schedule) {
  std::vector<std::string> reasons;
  if (problem.terms.empty()) return reasons;
  std::vector<Place> places = places_of_contacts_and_goals(problem, schedule);
  for (const TermUse& use : problem.terms) {
    std::optional<Place> place = place_of(problem.robot, use);
    if (!place) continue;
    for (const Place& other : places) {
      if (const auto reason = why_apart(problem, *place, other)) {
        reasons.push_back(*reason);
        break;
      }
    }
    places.push_back(std::move(*place));
  }
  return reasons;
}

}  // namespace prowl
