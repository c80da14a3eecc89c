#include "prowl/feasibility/slide_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "prowl/dynamics/body_bounds.hpp"
#include "prowl/feasibility/friction_support.hpp"
#include "prowl/feasibility/prescribed_footholds.hpp"

namespace prowl {

namespace {

using Eigen::Vector3d;

constexpr double kSlideMargin = 0.01;  // [m]; far above the tolerances of goals and contacts

/// Earliest and latest time of a moment [s].
struct TimeRange {
  double first = 0.0, last = 0.0;
};

TimeRange time_of(const MotionProblem& problem, PhaseFraction at) {
  TimeRange time;
  const auto add = [&](int phase, double part) {
    const Duration& duration = problem.phases[phase].duration;
    time.first += part * duration.min;
    time.last += part * duration.max;
  };
  for (int p = 0; p < at.phase; ++p) add(p, 1.0);
  add(at.phase, at.fraction);
  return time;
}

std::string friction_in_words(const std::vector<Surface>& surfaces) {
  if (surfaces.empty()) return "no contact holds the robot";
  const double factor = friction_factor_needed(surfaces);
  std::string text = "too little friction to stand: ";
  for (const Surface& surface : surfaces) {
    text += fmt::format("{}surface '{}' has {:.3g}", &surface == surfaces.data() ? "" : ", ", surface.name,
                        surface.friction);
    if (std::isfinite(factor)) text += fmt::format(" and needs {:.3g}", factor * surface.friction);
  }
  return std::isfinite(factor) ? text : text + "; no friction suffices";
}

/// A goal or contact that stops the slide of the centre of mass: d . c >= least_along_d.
struct Hold {
  std::string name;
  TimeRange time;
  double least_along_d;
};

std::vector<Hold> holds_of_phase(const MotionProblem& problem, const ContactSchedule& schedule, int p,
                                 const Vector3d& d) {
  const RobotModel& robot = problem.robot;
  const MassReach mass = mass_reach(robot);
  std::vector<Hold> holds;
  for (const BoundaryConstraint& constraint : problem.boundary_constraints) {
    if (constraint.at.phase != p) continue;
    holds.push_back({constraint.name, time_of(problem, constraint.at),
                     point_bounds(constraint, mass.centre).least_along(d) - mass.radius});
  }
  const auto footholds = prescribed_footholds(problem, schedule);
  const Phase& phase = problem.phases[p];
  for (int i = 0; i < static_cast<int>(phase.contacts.size()); ++i) {
    const auto& foothold = footholds[schedule.stance(p, i)];
    if (!foothold) continue;
    const int contact = phase.contacts[i].contact;
    const ContactReach leg = contact_reach(robot, contact);
    holds.push_back({"contact " + robot.contacts()[contact].name, time_of(problem, PhaseFraction::end_of(p)),
                     d.dot(*foothold) - (leg.length + (leg.root - mass.centre).norm() + mass.radius)});
  }
  return holds;
}

}  // namespace

std::optional<std::string> why_it_slides(const MotionProblem& problem, const ContactSchedule& schedule) {
  if (!problem.start().fixes_configuration() || !problem.start().fixes_velocity()) return std::nullopt;
  const MassMotion start = centre_of_mass(problem.robot, problem.start_configuration(), problem.start().velocity_lower);
  std::set<int> touched;
  for (int p = 0; p < static_cast<int>(problem.phases.size()); ++p) {
    const Phase& phase = problem.phases[p];
    for (const PhaseContact& contact : phase.contacts) touched.insert(contact.surface);
    std::vector<Surface> surfaces;
    for (const int surface : touched) surfaces.push_back(problem.surfaces[surface]);
    const auto slide = slide_on(surfaces);
    if (!slide) return std::nullopt;  // later phases only add surfaces

    const double speed = slide->direction.dot(start.velocity);
    const double acceleration = RobotModel::kGravity * slide->shortfall;
    for (const Hold& hold : holds_of_phase(problem, schedule, p, slide->direction)) {
      // The most favourable time in its range.
      const double time = std::clamp(speed / acceleration, hold.time.first, hold.time.last);
      const double slid = 0.5 * acceleration * time * time - speed * time;
      const double allowed = slide->direction.dot(start.position) - hold.least_along_d;
      if (!(slid > allowed + kSlideMargin)) continue;
      return fmt::format(
          "phase '{}': {}. Within {:.3g} s the robot would {} {:.2f} m or more, but {} allows at most "
          "{:.2f} m",
          phase.name, friction_in_words(surfaces), time, surfaces.empty() ? "fall" : "slide", slid, hold.name,
          std::max(0.0, allowed));
    }
  }
  return std::nullopt;
}

}  // namespace prowl
