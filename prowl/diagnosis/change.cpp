#include "prowl/diagnosis/change.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <set>

#include "prowl/dynamics/rigid_body_terms.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/model/so3.hpp"
#include "prowl/motion/contact_schedule.hpp"
#include "prowl/transcription/motion_limit.hpp"

namespace prowl {

namespace {

using Eigen::Index;
using Eigen::Vector3d;
using Eigen::VectorXd;

// Largest ratios that are tried. 0.8 is rubber on dry concrete, and who plans with more falls; what needs more than twenty
// times the torque or the time, or less than a twentieth of the way, is another task.
constexpr double kMostFriction = 0.8;
const double kMost = std::log(20.0);

// Forces and torques of a motion go with the way and with the square of the time, so that too little friction or torque
// is mended by a nearer goal or a longer phase, too, and by a smaller ratio of times. Where such a change is about
// equal to that of a limit, the limit is what is missing: a task that asks too much breaks several limits at once, and
// no change of one of them mends it.
constexpr double kWeightOfWay = 1.25;
constexpr double kWeightOfTime = 2.5;
constexpr double kWeightOfAllTimes = 3.0;

Knob friction_knob(const MotionProblem& problem, int surface) {
  const Surface& one = problem.surfaces[static_cast<std::size_t>(surface)];
  return {.kind = "friction", .subject = one.name, .most = std::log(kMostFriction / one.friction),
          .unit = "",
          .value = [&one](double a) { return one.friction * std::exp(a); },
          .problem = [&problem, surface](double a) {
            MotionProblem changed = problem;
            changed.surfaces[static_cast<std::size_t>(surface)].friction *= std::exp(a);
            return changed;
          }};
}

/// Phase -1: all together. sign -1: shorter.
Knob duration_knob(const MotionProblem& problem, int phase, double sign) {
  const auto scaled = [phase, sign](MotionProblem changed, double a) {
    for (int p = 0; p < static_cast<int>(changed.phases.size()); ++p) {
      if (phase >= 0 && p != phase) continue;
      Duration& duration = changed.phases[static_cast<std::size_t>(p)].duration;
      const bool fixed = duration.is_fixed();
      (sign > 0.0 ? duration.max : duration.min) *= std::exp(sign * a);
      // A flight that is too long may be too short, too: what lies between is left to the optimiser.
      if (fixed && sign > 0.0) duration.min = duration.max;
    }
    return changed;
  };
  return {.kind = "duration", .phase = phase,
          .subject = phase < 0 ? "" : problem.phases[static_cast<std::size_t>(phase)].name, .most = kMost,
          .is_asked = true, .weight = phase < 0 ? kWeightOfAllTimes : kWeightOfTime, .unit = "s",
          .value = [&problem, phase, sign](double a) {
            double time = 0.0;
            for (int p = 0; p < static_cast<int>(problem.phases.size()); ++p) {
              const Duration& duration = problem.phases[static_cast<std::size_t>(p)].duration;
              if (phase < 0 || p == phase) time += sign > 0.0 ? duration.max : duration.min;
            }
            return time * std::exp(sign * a);
          },
          .problem = [&problem, scaled](double a) { return scaled(problem, a); },
          .words = sign > 0.0 ? std::function<std::string(double)>() : [&problem, scaled, phase](double a) {
            const Duration duration = scaled(problem, a).phases[static_cast<std::size_t>(phase)].duration;
            return duration.is_fixed() ? fmt::format("{:.3g} s", duration.min) : fmt::format("[{:.3g}, {:.3g}] s", duration.min, duration.max);
          }};
}

/// Phases of a gait come from one number, and there are many: up to so many phases have durations of their own to turn.
constexpr int kMostPhases = 5;

constexpr std::size_t kStands = 3;  // contacts; on fewer a robot cannot stay for as long as it likes

LimitCurve::Table times(LimitCurve::Table table, double factor) {
  for (auto& [at, limit] : table) limit *= factor;
  return table;
}

/// Wider by the same on both sides, as far as a torque over the position is known.
void widen(JointLimits& limits, double lower, double upper, double factor) {
  const double more = 0.5 * (upper - lower) * (factor - 1.0);
  limits.position_lower = lower - more;
  limits.position_upper = upper + more;
  if (limits.torque_over_position.empty()) return;
  limits.position_lower = std::max(*limits.position_lower, std::min(lower, limits.torque_over_position.front().first));
  limits.position_upper = std::min(*limits.position_upper, std::max(upper, limits.torque_over_position.back().first));
}

MotionProblem with_joints(const MotionProblem& problem, LimitKind kind, const std::vector<int>& joints, double factor) {
  const RobotModel& robot = problem.robot;
  RobotDescription description = robot.description();
  for (const int j : joints) {
    JointLimits& limits = description.limits[robot.joint_names()[static_cast<std::size_t>(j)]];
    if (kind == LimitKind::torque) {
      if (std::isfinite(robot.torque_limit()(j))) limits.torque = factor * robot.torque_limit()(j);
      limits.torque_over_position = times(limits.torque_over_position, factor);
      limits.torque_over_velocity = times(limits.torque_over_velocity, factor);
    } else if (kind == LimitKind::joint_velocity) {
      limits.velocity = factor * robot.velocity_limit()(j);
    } else {
      widen(limits, robot.position_lower()(j), robot.position_upper()(j), factor);
    }
  }
  MotionProblem changed = problem;
  changed.robot = RobotModel(std::move(description));
  return changed;
}

std::string range_of(const RobotModel& robot, int joint) {
  return fmt::format("[{:.6g}, {:.6g}] {}", robot.position_lower()(joint), robot.position_upper()(joint),
                     limit_of_joint(robot, LimitKind::joint_position, joint).unit);
}

/// Which keys of a robot file are turned besides the torque limits of these joints.
std::string tables_with_torque(const RobotModel& robot, const std::vector<int>& joints, double factor) {
  std::set<std::string> tables;
  for (const RobotModel::TorqueCurve& curve : robot.torque_curves()) {
    if (std::ranges::find(joints, curve.joint) == joints.end()) continue;
    tables.insert(curve.over_velocity ? "torque_over_velocity" : "torque_over_position");
  }
  return tables.empty() ? "" : fmt::format("and {} times {:.5g}", fmt::join(tables, " and "), factor);
}

/// Of joints whose position ranges go with a factor those that are not so wide, for their torque is not known beyond.
std::string narrower_ranges(const MotionProblem& problem, const std::vector<int>& joints, double factor) {
  constexpr double kRounding = 1e-9;
  const RobotModel wider = with_joints(problem, LimitKind::joint_position, joints, factor).robot;
  std::vector<std::string> ranges;
  for (const int j : joints) {
    const double width = value_of_limit(problem.robot, LimitKind::joint_position, j);
    if (value_of_limit(wider, LimitKind::joint_position, j) >= factor * width * (1.0 - kRounding)) continue;
    ranges.push_back(fmt::format("{} {}", problem.robot.joint_names()[static_cast<std::size_t>(j)], range_of(wider, j)));
  }
  return ranges.empty() ? "" : fmt::format("but as far as torque_over_position goes {}", fmt::join(ranges, ", "));
}

/// The goal that part of the way from the start: pose, joints and velocities; not torques.
BoundaryCondition nearer(const MotionProblem& problem, BoundaryCondition goal, double part) {
  const VectorXd& start = problem.start_configuration();
  const int nu = problem.robot.nu();
  goal.q_ref.head<3>() = start.head<3>() + part * (goal.q_ref - start).head<3>();
  goal.q_ref.tail(nu) = start.tail(nu) + part * (goal.q_ref - start).tail(nu);
  const Eigen::Matrix3d from = base_rotation(start);
  const Vector3d turn = so3::log(from.transpose() * base_rotation(goal.q_ref));
  set_base_rotation(goal.q_ref, from * so3::exp(part * turn));
  for (int i = 0; i < problem.robot.nv(); ++i) {
    if (i >= 3 && i < 6) continue;  // bounds on a rotation stay as wide as they are
    goal.configuration_lower(i) *= part;
    goal.configuration_upper(i) *= part;
  }
  goal.velocity_lower *= part;
  goal.velocity_upper *= part;
  return goal;
}

/// An entry of a goal, and how far it is from the start, in its unit.
struct Away {
  MotionLimit entry;
  double off = 0.0;
  std::optional<double> at = {};  ///< the coordinate that it asks for, if it has one
  int entries = 0;  ///< that are away from the start
};

/// The entry that is farthest away, each measured by its size. None: off is 0.
Away farthest(const MotionProblem& problem, const BoundaryCondition& goal) {
  const RobotModel& robot = problem.robot;
  const VectorXd& start = problem.start_configuration();
  Away most;
  const auto look = [&most](const MotionLimit& entry, double lower, double upper, std::optional<double> from = {}) {
    const double off = lower > 0.0 ? lower : upper < 0.0 ? upper : 0.0;
    if (off == 0.0 || !std::isfinite(off)) return;
    const int entries = most.entries + 1;
    if (std::abs(off) / entry.size > std::abs(most.off) / most.entry.size + 1e-9) most = {entry, off, from ? std::optional(*from + off) : from};
    most.entries = entries;
  };
  for (int i = 0; i < robot.nv(); ++i) {
    if (i >= 3 && i < 6) continue;
    const Index at = i < 3 ? i : i + 1;  // a configuration has a quaternion where its tangent has a rotation
    const double shift = goal.q_ref(at) - start(at);
    look(limit_of_goal(robot, goal.name, i, false), shift + goal.configuration_lower(i), shift + goal.configuration_upper(i),
         start(at));
  }
  if (goal.configuration_lower.segment<3>(3).allFinite()) {
    MotionLimit rotation = limit_of_goal(robot, goal.name, 3, false);
    rotation.subject = goal.name + ", rotation";
    const double turn = so3::log(base_rotation(start).transpose() * base_rotation(goal.q_ref)).norm();
    look(rotation, turn, turn);
  }
  for (int i = 0; i < robot.nv(); ++i) {
    look(limit_of_goal(robot, goal.name, i, true), goal.velocity_lower(i), goal.velocity_upper(i));
  }
  return most;
}

Knob goal_knob(const MotionProblem& problem, std::size_t condition, const Away& away) {
  return {.kind = "goal", .phase = problem.boundary_conditions[condition].at.phase, .subject = away.entry.subject, .most = kMost,
          .is_asked = true, .weight = kWeightOfWay, .unit = away.entry.unit,
          .value = [off = away.off](double a) { return off * std::exp(-a); },
          .problem = [&problem, condition](double a) {
            MotionProblem changed = problem;
            changed.boundary_conditions[condition] = nearer(problem, problem.boundary_conditions[condition], std::exp(-a));
            return changed;
          },
          .words = [away](double a) {
            const double off = away.off * std::exp(-a);
            if (!away.at) return fmt::format("{:.3g} {}", off, away.entry.unit);
            const double at = *away.at - away.off + off;
            return fmt::format("{:.6g} {unit} ({:.3g} {unit} from the start)", at, off, fmt::arg("unit", away.entry.unit));
          },
          .besides = [away](double a) {
            return away.entries > 1 ? fmt::format("all that it asks for {:.3g} times as far from the start", std::exp(-a)) : "";
          }};
}

/// A place brought nearer to where its contact was at the start or before it opened.
Knob place_knob(const MotionProblem& problem, int phase, std::size_t held, const Vector3d& from) {
  const PhaseContact& contact = problem.phases[static_cast<std::size_t>(phase)].contacts[held];
  const Surface& surface = problem.surfaces[static_cast<std::size_t>(contact.surface)];
  const Vector3d to = *contact.place;
  const Vector3d root = from - (from - to).dot(surface.normal) * surface.normal;  // on the surface, as the place is
  return {.kind = "place", .phase = phase,
          .subject = problem.robot.contacts()[static_cast<std::size_t>(contact.contact)].name, .most = kMost,
          .is_asked = true, .weight = kWeightOfWay, .unit = "m",
          .value = [root, to](double a) { return std::exp(-a) * (to - root).norm(); },
          .problem = [&problem, phase, held, root, to](double a) {
            MotionProblem changed = problem;
            changed.phases[static_cast<std::size_t>(phase)].contacts[held].place = root + std::exp(-a) * (to - root);
            return changed;
          }};
}

void add_places(const MotionProblem& problem, std::vector<Knob>& knobs) {
  const ContactSchedule schedule(problem);
  RigidBodyTerms terms(problem.robot);
  terms.update_kinematics(problem.start_configuration());
  for (int p = 1; p < static_cast<int>(problem.phases.size()); ++p) {
    const auto& contacts = problem.phases[static_cast<std::size_t>(p)].contacts;
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      if (!contacts[i].place || !schedule.lands(p, static_cast<int>(i))) continue;
      std::optional<Vector3d> from = terms.contact_position(contacts[i].contact);
      for (const Stance& stance : schedule.stances()) {
        if (stance.contact == contacts[i].contact && stance.last_phase < p && stance.lands()) from = stance.place;
      }
      if (from) knobs.push_back(place_knob(problem, p, i, *from));
    }
  }
}

}  // namespace

double printable_amount(const Knob& knob, double amount) {
  constexpr double kRounding = 1e-9;
  const double from = std::abs(knob.value(0.0)), to = std::abs(knob.value(amount));
  if (from == 0.0) return amount;  // friction of ice: no factor helps
  const double digit = std::pow(10.0, std::floor(std::log10(to)) - 2.0);
  const double rounded = digit * (to > from ? std::ceil(to / digit - kRounding) : std::floor(to / digit + kRounding));
  const double more = std::min(std::abs(std::log(rounded / from)), knob.most);
  return more >= amount - kRounding ? more : amount;  // a range that may not be wider
}

double value_of_limit(const RobotModel& robot, LimitKind kind, int joint) {
  if (kind == LimitKind::torque) return robot.torque_limit()(joint);
  if (kind == LimitKind::joint_velocity) return robot.velocity_limit()(joint);
  return robot.position_upper()(joint) - robot.position_lower()(joint);
}

Knob joint_knob(const MotionProblem& problem, LimitKind kind, const std::vector<int>& joints) {
  const RobotModel& robot = problem.robot;
  const int first = joints.front();
  const auto range = [&problem, kind, joints, first](double a) {
    return range_of(with_joints(problem, kind, joints, std::exp(a)).robot, first);
  };
  std::vector<std::string> names;
  for (const int j : joints) names.push_back(robot.joint_names()[static_cast<std::size_t>(j)]);
  const bool all = static_cast<int>(joints.size()) == robot.nu();
  const bool several = joints.size() > 1;  // whose limits may differ: the factor is what they have in common
  return {.kind = to_string(kind), .subject = all ? "" : fmt::format("{}", fmt::join(names, ", ")), .most = kMost,
          .unit = several ? "" : limit_of_joint(robot, kind, first).unit,
          .value = [&problem, kind, joints, several, first](double a) {
            return several ? std::exp(a) : value_of_limit(with_joints(problem, kind, joints, std::exp(a)).robot, kind, first);
          },
          .problem = [&problem, kind, joints](double a) { return with_joints(problem, kind, joints, std::exp(a)); },
          .words = several || kind != LimitKind::joint_position ? std::function<std::string(double)>() : range,
          .besides = [&problem, kind, joints, several](double a) {
            if (kind == LimitKind::torque) return tables_with_torque(problem.robot, joints, std::exp(a));
            return several && kind == LimitKind::joint_position ? narrower_ranges(problem, joints, std::exp(a)) : "";
          }};
}

std::vector<Knob> knobs_of(const MotionProblem& problem) {
  std::vector<Knob> knobs;
  std::set<int> surfaces;
  for (const Phase& phase : problem.phases) {
    for (const PhaseContact& contact : phase.contacts) surfaces.insert(contact.surface);
  }
  for (const int surface : surfaces) {
    if (problem.surfaces[static_cast<std::size_t>(surface)].friction < kMostFriction) knobs.push_back(friction_knob(problem, surface));
  }
  for (std::size_t c = 1; c < problem.boundary_conditions.size(); ++c) {
    const Away away = farthest(problem, problem.boundary_conditions[c]);
    if (away.off != 0.0) knobs.push_back(goal_knob(problem, c, away));
  }
  add_places(problem, knobs);
  std::vector<int> joints(static_cast<std::size_t>(problem.robot.nu()));
  std::iota(joints.begin(), joints.end(), 0);
  for (const LimitKind kind : {LimitKind::torque, LimitKind::joint_velocity, LimitKind::joint_position}) {
    std::vector<int> turned = joints;
    // Their torque over the velocity is known up to the limit only.
    const auto has_curve = [&](int j) {
      return std::ranges::any_of(problem.robot.torque_curves(), [j](const auto& curve) { return curve.joint == j && curve.over_velocity; });
    };
    if (kind == LimitKind::joint_velocity) std::erase_if(turned, has_curve);
    if (!turned.empty()) knobs.push_back(joint_knob(problem, kind, turned));
  }
  const int phases = static_cast<int>(problem.phases.size());
  for (int p = 0; p < phases && phases <= kMostPhases; ++p) {
    knobs.push_back(duration_knob(problem, p, 1.0));
    const bool may_be_shorter = problem.phases[static_cast<std::size_t>(p)].contacts.size() < kStands;
    if (may_be_shorter) knobs.push_back(duration_knob(problem, p, -1.0));
  }
  if (phases > 1) knobs.push_back(duration_knob(problem, -1, 1.0));
  if (phases > 1 && problem.swing_clearance > 0.0) {
    knobs.push_back({.kind = "clearance", .subject = "", .most = kMost, .is_asked = true, .weight = kWeightOfWay, .unit = "m",
                     .value = [&problem](double a) { return problem.swing_clearance * std::exp(-a); },
                     .problem = [&problem](double a) {
                       MotionProblem changed = problem;
                       changed.swing_clearance *= std::exp(-a);
                       return changed;
                     }});
  }
  return knobs;
}

}  // namespace prowl
