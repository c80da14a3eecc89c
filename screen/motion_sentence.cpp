#include "screen/motion_sentence.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

#include "prowl/model/configuration.hpp"
#include "prowl/motion/contact_schedule.hpp"

namespace prowl {
namespace {

using Eigen::Vector3d;

constexpr double kVisibleMove = 0.01, kVisibleHeight = 0.02;  // [m]
constexpr double kVisibleTurn = 0.05;                         // [rad]

std::string length(double metres) {
  return metres < 0.995 ? fmt::format("{:.0f} cm", 100.0 * metres) : fmt::format("{:.2f} m", metres);
}

std::string counted(std::size_t number, const char* one, const char* many) {
  return fmt::format("{} {}", number, number == 1 ? one : many);
}

/// "20 cm forward"; without a direction where it goes askew.
std::string travel(const Vector3d& d) {
  const double x = std::abs(d.x()), y = std::abs(d.y());
  const char* const direction = x >= 2.0 * y   ? (d.x() > 0.0 ? " forward" : " backward")
                                : y >= 2.0 * x ? (d.y() > 0.0 ? " to the left" : " to the right")
                                               : "";
  return length(d.head<2>().norm()) + direction;
}

/// Displacement of the base from the start at each node, along its heading at the start.
std::vector<Vector3d> displacements(const Trajectory& trajectory) {
  const Eigen::VectorXd& start = trajectory.nodes.front().q;
  const double yaw = heading(start), c = std::cos(yaw), s = std::sin(yaw);
  std::vector<Vector3d> all;
  for (const TrajectoryPoint& node : trajectory.nodes) {
    const Vector3d d = base_position(node.q) - base_position(start);
    all.emplace_back(c * d.x() + s * d.y(), c * d.y() - s * d.x(), d.z());
  }
  return all;
}

/// Feet that do something at the start of a phase; contacts on one frame are one foot.
using FootEvents = std::set<std::pair<std::string, int>>;

FootEvents landings(const MotionProblem& problem, const ContactSchedule& schedule) {
  FootEvents events;
  for (const ContactStance& stance : schedule.stances()) {
    if (stance.lands()) events.emplace(problem.robot.contacts()[stance.contact].frame, stance.first_phase);
  }
  return events;
}

/// Feet that lift and stay in the air.
std::set<std::string> lifted(const MotionProblem& problem, const ContactSchedule& schedule) {
  std::set<std::string> feet;
  for (const ContactSwing& swing : schedule.swings()) {
    if (swing.before >= 0 && swing.after < 0) feet.insert(problem.robot.contacts()[swing.contact].frame);
  }
  return feet;
}

/// Of a base over feet that stay where they are.
std::string base_in_words(const Trajectory& trajectory, const std::vector<Vector3d>& d) {
  const auto [low, high] =
      std::ranges::minmax_element(d, [](const Vector3d& a, const Vector3d& b) { return a.z() < b.z(); });
  const double down = -low->z(), up = high->z(), end = d.back().z();
  if (down >= kVisibleHeight && down >= up) {
    return end > -0.3 * down ? fmt::format("crouches {} and stands up again", length(down))
                             : fmt::format("lowers its base by {}", length(-end));
  }
  if (up >= kVisibleHeight) return fmt::format("raises its base by {}", length(up));
  double farthest = 0.0;
  for (const Vector3d& one : d) farthest = std::max(farthest, one.norm());
  if (farthest >= kVisibleMove) return fmt::format("moves its base by {}", length(farthest));
  const Eigen::Matrix3d turn =
      base_rotation(trajectory.nodes.front().q).transpose() * base_rotation(trajectory.nodes.back().q);
  const double angle = Eigen::AngleAxisd(turn).angle();
  return angle >= kVisibleTurn ? fmt::format("turns its base by {:.0f} degrees", angle * 180.0 / std::numbers::pi)
                               : "stands still";
}

/// Friction that is left at a contact with load: the least of all nodes.
struct FrictionMargin {
  double newtons = std::numeric_limits<double>::infinity();
  std::string contact;
};

FrictionMargin least_friction_margin(const MotionProblem& problem, const Trajectory& trajectory) {
  constexpr double kLoaded = 0.02;  // of the weight
  FrictionMargin least;
  for (const TrajectoryPoint& node : trajectory.nodes) {
    for (const PhaseContact& held : problem.phases[node.phase].contacts) {
      const Surface& surface = problem.surfaces[held.surface];
      const Vector3d force = node.force.segment<3>(3 * held.contact);
      const double normal = force.dot(surface.normal);
      if (normal < kLoaded * problem.robot.weight()) continue;
      const double margin = surface.friction * normal - (force - normal * surface.normal).norm();
      if (margin < least.newtons) least = {margin, problem.robot.contacts()[held.contact].name};
    }
  }
  return least;
}

}  // namespace

std::string motion_in_words(const MotionProblem& problem, const Trajectory& trajectory) {
  const std::string& robot = problem.robot.name();
  if (trajectory.empty()) return robot + " does nothing";
  const ContactSchedule schedule(problem);
  const std::vector<Vector3d> d = displacements(trajectory);
  const bool travels = d.back().head<2>().norm() >= kVisibleMove;
  const bool flies = std::ranges::any_of(problem.phases, [](const Phase& phase) { return phase.contacts.empty(); });
  if (flies) return fmt::format("{} jumps{}", robot, travels ? fmt::format(" {}", travel(d.back())) : "");
  if (const std::size_t steps = landings(problem, schedule).size(); steps > 0) {
    return fmt::format("{} takes {}{}", robot, counted(steps, "step", "steps"),
                       travels ? fmt::format(" and moves {}", travel(d.back())) : "");
  }
  const std::size_t feet = lifted(problem, schedule).size();
  return fmt::format("{} {}{}", robot, base_in_words(trajectory, d),
                     feet == 0 ? "" : fmt::format(" and lifts {}", counted(feet, "foot", "feet")));
}

std::string torque_in_words(const Certificate& certificate) {
  const CertificateCheck* const torque = certificate.find("joint torque");
  if (!torque || !std::isfinite(torque->worst)) return "";
  return fmt::format("Largest torque: {:.0f} % of its limit{}.", 100.0 * torque->worst,
                     torque->where.empty() ? "" : fmt::format(" at {}", torque->where));
}

std::string missing_margin(const MotionProblem& problem, const Trajectory& trajectory, const Certificate& certificate) {
  constexpr double kNextToNothing = 1e-3;  // of the weight, or of the limit of a joint
  std::vector<std::string> missing;
  if (const FrictionMargin friction = least_friction_margin(problem, trajectory);
      friction.newtons < kNextToNothing * problem.robot.weight()) {
    missing.push_back(fmt::format("friction at {} ({:.2g} N left)", friction.contact, std::max(0.0, friction.newtons)));
  }
  for (const auto& [name, what] : {std::pair{"joint torque", "torque"}, {"joint velocity", "velocity"}}) {
    const CertificateCheck* const check = certificate.find(name);
    if (!check || !(check->worst > 1.0 - kNextToNothing)) continue;
    missing.push_back(fmt::format("{} of {} ({:.0f} % of its limit)", what, check->where, 100.0 * check->worst));
  }
  return missing.empty() ? "" : fmt::format("next to no margin: {}", fmt::join(missing, ", "));
}

}  // namespace prowl
