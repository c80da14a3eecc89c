#include "prowl/motion/motion_problem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "prowl/dynamics/contact_kinematics.hpp"
#include "prowl/error.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/model/surface.hpp"
#include "prowl/motion/check_terms.hpp"

namespace prowl {

namespace {

using Eigen::VectorXd;

constexpr double kOnSurface = 1e-3;   // [m]
constexpr double kAtRest = 1e-3;      // [m/s]
constexpr double kUnitLength = 1e-6;  // [-]
constexpr double kRounding = 1e-9;    // [rad, m, rad/s, m/s, N m]

template <class... Args>
[[noreturn]] void refuse(fmt::format_string<Args...> format, Args&&... args) {
  throw InputError(fmt::format(format, std::forward<Args>(args)...));
}

void check_size(const std::string& field, const VectorXd& values, int size) {
  if (values.size() != size) refuse("{}: {} entries are not allowed; need {}", field, values.size(), size);
}

void check_finite(const std::string& field, const VectorXd& values, int size) {
  check_size(field, values, size);
  for (Eigen::Index i = 0; i < size; ++i) {
    if (!std::isfinite(values(i))) refuse("{}[{}]: {} is not allowed; need a finite number", field, i, values(i));
  }
}

void check_index(const std::string& field, int index, std::size_t size) {
  if (index < 0 || index >= static_cast<int>(size)) {
    refuse("{}: {} is not allowed; need 0 to {}", field, index, static_cast<int>(size) - 1);
  }
}

void check_configuration(const std::string& field, const VectorXd& q, int nq) {
  check_finite(field, q, nq);
  const double norm = base_quaternion(q).norm();
  if (std::abs(norm - 1.0) > kUnitLength)
    refuse("{}: base quaternion of length {} is not allowed; need 1", field, norm);
}

void check_surface(const std::string& field, const Surface& surface) {
  check_finite(field + ".point", surface.point, 3);
  check_finite(field + ".normal", surface.normal, 3);
  if (std::abs(surface.normal.norm() - 1.0) > kUnitLength) {
    refuse("{}.normal: length {} is not allowed; need 1", field, surface.normal.norm());
  }
  if (!(surface.friction > 0.0) || !std::isfinite(surface.friction)) {
    refuse("{}.friction: {} is not allowed; need a coefficient > 0", field, surface.friction);
  }
  if (surface.patch.empty()) return;
  if (const std::string fault = Surface::patch_fault(surface.patch); !fault.empty())
    refuse("{}.patch: {}", field, fault);
}

void check_foothold(const MotionProblem& problem, const std::string& field, const PhaseContact& contact) {
  const Surface& surface = problem.surfaces[contact.surface];
  check_finite(field, *contact.foothold, 3);
  const double gap = surface.distance(*contact.foothold);
  if (std::abs(gap) > kOnSurface) {
    refuse("{}: {:.1f} mm {} surface '{}' is not allowed; need a place on it", field, 1e3 * std::abs(gap),
           gap > 0.0 ? "above" : "below", surface.name);
  }
  if (!surface.contains(surface.coordinates(*contact.foothold))) {
    refuse("{}: outside the patch of surface '{}'", field, surface.name);
  }
}

void check_phase(const MotionProblem& problem, const std::string& field, const Phase& phase) {
  const Duration& duration = phase.duration;
  if (!(duration.min > 0.0) || !(duration.min <= duration.max) || !std::isfinite(duration.max)) {
    refuse("{}.duration: {} to {} is not allowed; need 0 < min <= max [s]", field, duration.min, duration.max);
  }
  std::set<int> used;
  for (std::size_t i = 0; i < phase.contacts.size(); ++i) {
    const std::string contact = fmt::format("{}.contacts[{}]", field, i);
    check_index(contact + ".contact", phase.contacts[i].contact, problem.robot.contacts().size());
    check_index(contact + ".surface", phase.contacts[i].surface, problem.surfaces.size());
    if (!used.insert(phase.contacts[i].contact).second) {
      refuse("{}: '{}' is listed twice; need each contact once", contact,
             problem.robot.contacts()[phase.contacts[i].contact].name);
    }
    if (phase.contacts[i].foothold) check_foothold(problem, contact + ".foothold", phase.contacts[i]);
  }
}

/// A contact holds one surface until it opens.
void check_surfaces_of_contacts(const MotionProblem& problem) {
  for (std::size_t p = 1; p < problem.phases.size(); ++p) {
    for (const PhaseContact& held : problem.phases[p].contacts) {
      for (const PhaseContact& before : problem.phases[p - 1].contacts) {
        if (held.contact != before.contact || held.surface == before.surface) continue;
        refuse(
            "phases[{}]: contact '{}' goes from surface '{}' to '{}' without opening; need a phase in between in which "
            "it is open",
            p, problem.robot.contacts()[held.contact].name, problem.surfaces[before.surface].name,
            problem.surfaces[held.surface].name);
      }
    }
  }
}

void check_bounds(const std::string& field, const VectorXd& lower, const VectorXd& upper, int size) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  check_size(field + "_lower", lower, size);
  check_size(field + "_upper", upper, size);
  for (Eigen::Index i = 0; i < size; ++i) {
    if (!(lower(i) <= upper(i)) || lower(i) == kInfinity || upper(i) == -kInfinity) {
      refuse("{}[{}]: {} to {} is not allowed; need lower <= upper", field, i, lower(i), upper(i));
    }
  }
}

/// Bounds on the joints must overlap the robot's limits.
void check_within_robot(const std::string& field, const RobotModel& robot, const VectorXd& lower, const VectorXd& upper,
                        const VectorXd& robot_lower, const VectorXd& robot_upper) {
  for (Eigen::Index j = 0; j < robot.nu(); ++j) {
    if (lower(j) <= robot_upper(j) + kRounding && upper(j) >= robot_lower(j) - kRounding) continue;
    refuse("{}: {} to {} for joint '{}' is outside its limits; need some part of {} to {}", field, lower(j), upper(j),
           robot.joint_names()[j], robot_lower(j), robot_upper(j));
  }
}

void check_constraint(const MotionProblem& problem, const std::string& field, const BoundaryConstraint& constraint) {
  const RobotModel& robot = problem.robot;
  check_index(field + ".at.phase", constraint.at.phase, problem.phases.size());
  if (!(constraint.at.fraction >= 0.0 && constraint.at.fraction <= 1.0)) {
    refuse("{}.at.fraction: {} is not allowed; need 0 to 1", field, constraint.at.fraction);
  }
  check_configuration(field + ".q_ref", constraint.q_ref, robot.nq());
  check_bounds(field + ".configuration", constraint.configuration_lower, constraint.configuration_upper, robot.nv());
  check_bounds(field + ".velocity", constraint.velocity_lower, constraint.velocity_upper, robot.nv());
  check_bounds(field + ".torque", constraint.torque_lower, constraint.torque_upper, robot.nu());

  const int nu = robot.nu();
  const VectorXd joints = constraint.q_ref.tail(nu);
  check_within_robot(field + ".configuration", robot, joints + constraint.configuration_lower.tail(nu),
                     joints + constraint.configuration_upper.tail(nu), robot.position_lower(), robot.position_upper());
  check_within_robot(field + ".velocity", robot, constraint.velocity_lower.tail(nu), constraint.velocity_upper.tail(nu),
                     -robot.velocity_limit(), robot.velocity_limit());
  check_within_robot(field + ".torque", robot, constraint.torque_lower, constraint.torque_upper, -robot.torque_limit(),
                     robot.torque_limit());
}

/// Only a contact that lands may have a foothold.
void check_footholds(const MotionProblem& problem) {
  const auto holds = [&](std::size_t p, int contact) {
    const auto& contacts = problem.phases[p].contacts;
    return std::ranges::find(contacts, contact, &PhaseContact::contact) != contacts.end();
  };
  for (std::size_t p = 0; p < problem.phases.size(); ++p) {
    const auto& contacts = problem.phases[p].contacts;
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      const bool lands = p > 0 && !holds(p - 1, contacts[i].contact);
      if (!contacts[i].foothold || lands) continue;
      refuse(
          "phases[{}].contacts[{}].foothold: contact '{}' does not land in this phase: it {}; need no place, or the "
          "phase "
          "in which it lands",
          p, i, problem.robot.contacts()[contacts[i].contact].name,
          p == 0 ? "starts at its position in the start posture" : "already stands in the phase before");
    }
  }
}

/// No contact point, held or not, starts inside a surface without an edge.
void check_start_outside(const MotionProblem& problem, const RigidBodyTerms& terms) {
  for (int c = 0; c < static_cast<int>(problem.robot.contacts().size()); ++c) {
    const ContactPoint& contact = problem.robot.contacts()[c];
    for (const Surface& surface : problem.surfaces) {
      const double gap = surface.distance(terms.contact_position(c)) - contact.radius;
      if (!surface.patch.empty() || gap >= -kOnSurface) continue;
      refuse(
          "boundary_constraints[0].q_ref: contact '{}' starts {:.1f} mm inside surface '{}'; need another start, or "
          "a normal that points towards the robot",
          contact.name, -1e3 * gap, surface.name);
    }
  }
}

/// The contacts of the first phase must be on their surfaces, inside their patches, and at rest.
void check_start_contacts(const MotionProblem& problem, const RigidBodyTerms& terms) {
  const Phase& phase = problem.phases.front();
  ContactKinematics kinematics(contact_indices(phase.contacts));
  kinematics.set_configuration(terms);
  const BoundaryConstraint& start = problem.start();
  const bool is_fixed = start.fixes_configuration() && start.fixes_velocity();
  const VectorXd velocities =
      kinematics.jacobian() * (is_fixed ? start.velocity_lower : VectorXd::Zero(problem.robot.nv()));

  for (std::size_t i = 0; i < phase.contacts.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(3 * i);
    const ContactPoint& contact = problem.robot.contacts()[phase.contacts[i].contact];
    const Surface& surface = problem.surfaces[phase.contacts[i].surface];
    const double gap = surface.distance(kinematics.positions().segment<3>(row)) - contact.radius;
    if (!(std::abs(gap) <= kOnSurface)) {
      refuse(
          "boundary_constraints[0].q_ref: contact '{}' of the first phase is {:.1f} mm {} surface '{}'; need at most "
          "{} mm",
          contact.name, 1e3 * std::abs(gap), gap > 0.0 ? "above" : "inside", surface.name, 1e3 * kOnSurface);
    }
    const Eigen::Vector2d on_surface = surface.coordinates(kinematics.positions().segment<3>(row));
    const double outside = (on_surface - nearest_in_patch(surface, on_surface)).norm();
    if (outside > kOnSurface) {
      refuse(
          "boundary_constraints[0].q_ref: contact '{}' of the first phase is {:.1f} mm outside the patch of surface "
          "'{}'; need "
          "at most {} mm",
          contact.name, 1e3 * outside, surface.name, 1e3 * kOnSurface);
    }
    const double speed = velocities.segment<3>(row).norm();
    if (!(speed <= kAtRest)) {
      refuse(
          "boundary_constraints[0].velocity: contact '{}' of the first phase moves at {:.4g} m/s; need at most {} m/s",
          contact.name, speed, kAtRest);
    }
  }
}

/// Each rotation is bound about its own q_ref, so only one condition per time may bind it.
void check_rotations(const MotionProblem& problem) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::map<double, std::size_t> binding;  // by elapsed phases: both sides of a phase transition are one time
  for (std::size_t i = 0; i < problem.boundary_constraints.size(); ++i) {
    const BoundaryConstraint& constraint = problem.boundary_constraints[i];
    if (constraint.configuration_lower.segment<3>(3).maxCoeff() == -kInfinity &&
        constraint.configuration_upper.segment<3>(3).minCoeff() == kInfinity) {
      continue;
    }
    const auto [other, is_first] = binding.insert({constraint.at.phase + constraint.at.fraction, i});
    if (is_first) continue;
    refuse(
        "boundary_constraints[{}].configuration: it binds the base's rotation at the same time as "
        "boundary_constraints[{}]; need one condition there",
        i, other->second);
  }
}

void check_weightless(const std::string& field, const VectorXd& weights) {
  if (!weights.isZero(0.0)) refuse("{}: has no meaning in a terminal cost; need 0", field);
}

void check_start(const MotionProblem& problem) {
  const BoundaryConstraint& start = problem.start();
  if (!(start.at == PhaseFraction::start_of(0))) {
    refuse(
        "boundary_constraints[0].at: phase {}, fraction {} is not allowed; the first condition is the start, need 0, 0",
        start.at.phase, start.at.fraction);
  }
  if (start.fixes_configuration() && !start.configuration_lower.isZero(0.0)) {
    refuse("boundary_constraints[0].configuration: a fixed start is its q_ref; need bounds of 0");
  }
  RigidBodyTerms terms(problem.robot);
  terms.update_kinematics(problem.start_configuration());
  check_start_contacts(problem, terms);
  check_start_outside(problem, terms);
}

void check_cycle(const MotionProblem& problem) {
  if (!problem.cycle) return;
  const Cycle& cycle = *problem.cycle;
  if (cycle.count < 1 || static_cast<int>(problem.phases.size()) % cycle.count != 0) {
    refuse("cycle.count: {} is not allowed; need a divisor of the {} phases", cycle.count, problem.phases.size());
  }
  check_finite("cycle.displacement", cycle.displacement, 3);
  if (!std::isfinite(cycle.turn)) refuse("cycle.turn: {} is not allowed; need an angle [rad]", cycle.turn);
  const auto contacts_of = [](const Phase& phase) {
    const std::vector<int> held = contact_indices(phase.contacts);
    return std::set<int>(held.begin(), held.end());
  };
  if (contacts_of(problem.phases.front()) != contacts_of(problem.phases.back())) {
    refuse(
        "cycle: the first and the last phase hold different contacts; need the same, as the one continues the other");
  }
  if (problem.boundary_constraints.size() > 1) {
    refuse("cycle: goals are not allowed beside a cycle, whose end is its start; need none");
  }
}

void check_weights(const std::string& field, const VectorXd& weights, int size) {
  check_finite(field, weights, size);
  for (Eigen::Index i = 0; i < size; ++i) {
    if (weights(i) < 0.0) refuse("{}[{}]: {} is not allowed; need a weight >= 0", field, i, weights(i));
  }
}

void check_cost(const std::string& field, const RobotModel& robot, const QuadraticCost& cost) {
  check_configuration(field + ".q_ref", cost.q_ref, robot.nq());
  check_weights(field + ".configuration_weight", cost.configuration_weight, robot.nv());
  check_weights(field + ".velocity_weight", cost.velocity_weight, robot.nv());
  check_weights(field + ".acceleration_weight", cost.acceleration_weight, robot.nv());
  check_finite(field + ".tau_ref", cost.tau_ref, robot.nu());
  check_weights(field + ".torque_weight", cost.torque_weight, robot.nu());
  check_weights(field + ".force_weight", cost.force_weight, 3);
  check_weights(field + ".time_weight", VectorXd::Constant(1, cost.time_weight), 1);
  for (std::size_t i = 0; i < cost.contact_positions.size(); ++i) {
    const std::string entry = fmt::format("{}.contact_positions[{}]", field, i);
    check_index(entry + ".contact", cost.contact_positions[i].contact, robot.contacts().size());
    check_finite(entry + ".reference", cost.contact_positions[i].reference, 3);
    check_weights(entry + ".weight", cost.contact_positions[i].weight, 3);
  }
}

void check_tolerance(const std::string& field, double tolerance) {
  if (!(tolerance > 0.0) || !std::isfinite(tolerance)) {
    refuse("goal_tolerance.{}: {} is not allowed; need a number > 0", field, tolerance);
  }
}

}  // namespace

BoundaryConstraint BoundaryConstraint::unbounded(const RobotModel& robot, std::string name, PhaseFraction at,
                                                 const Eigen::VectorXd& q_ref) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  BoundaryConstraint constraint;
  constraint.name = std::move(name);
  constraint.at = at;
  constraint.q_ref = q_ref;
  constraint.configuration_lower = constraint.velocity_lower = VectorXd::Constant(robot.nv(), -kInfinity);
  constraint.configuration_upper = constraint.velocity_upper = VectorXd::Constant(robot.nv(), kInfinity);
  constraint.torque_lower = VectorXd::Constant(robot.nu(), -kInfinity);
  constraint.torque_upper = VectorXd::Constant(robot.nu(), kInfinity);
  return constraint;
}

std::vector<PhaseFraction> node_moments(const MotionProblem& problem) {
  std::vector<PhaseFraction> moments;
  for (const BoundaryConstraint& constraint : problem.boundary_constraints) moments.push_back(constraint.at);
  for (const TermUse& use : problem.terms) moments.insert(moments.end(), {use.from, use.to});
  return moments;
}

Eigen::VectorXd Cycle::moved_configuration(const VectorXd& q) const {
  VectorXd result = q;
  result.head<3>() = moved(base_position(q));
  set_base_rotation(result, rotation() * base_rotation(q));
  return result;
}

bool ends_at_rest(const MotionProblem& problem) {
  const auto last = static_cast<int>(problem.phases.size()) - 1;
  return !problem.cycle && std::ranges::any_of(problem.boundary_constraints, [&](const BoundaryConstraint& goal) {
    return goal.at == PhaseFraction::end_of(last) && goal.velocity_lower.head<6>().isZero(0.0) &&
           goal.velocity_upper.head<6>().isZero(0.0);
  });
}

bool can_stand_at_end(const MotionProblem& problem) {
  constexpr std::size_t kFewest = 3;  // two give no moment about their line
  return ends_at_rest(problem) && problem.phases.back().contacts.size() >= kFewest;
}

double least_load(const MotionProblem& problem, const Phase& phase, const PhaseContact& contact) {
  if (contact.unloaded) return 0.0;
  const double even = problem.robot.weight() / static_cast<double>(phase.contacts.size());
  return problem.least_load * even * std::max(0.0, problem.surfaces[contact.surface].normal.z());
}

void validate(const MotionProblem& problem) {
  for (std::size_t i = 0; i < problem.surfaces.size(); ++i) {
    check_surface(fmt::format("surfaces[{}]", i), problem.surfaces[i]);
  }
  if (problem.phases.empty()) refuse("phases: an empty list is not allowed; need one phase or more");
  for (std::size_t i = 0; i < problem.phases.size(); ++i) {
    check_phase(problem, fmt::format("phases[{}]", i), problem.phases[i]);
  }
  check_surfaces_of_contacts(problem);
  check_footholds(problem);
  if (!(problem.swing_clearance >= 0.0) || !std::isfinite(problem.swing_clearance)) {
    refuse("swing_clearance: {} is not allowed; need a length >= 0 [m]", problem.swing_clearance);
  }
  if (!(problem.least_load >= 0.0) || !(problem.least_load < 1.0)) {
    refuse("least_load: {} is not allowed; need a share >= 0 and < 1", problem.least_load);
  }
  if (problem.stands_at_end && !can_stand_at_end(problem)) {
    refuse("stands_at_end: true is not allowed; need a goal that stops the base at the end, on three contacts or more");
  }
  if (problem.boundary_constraints.empty()) {
    refuse("boundary_constraints: an empty list is not allowed; need the start as the first");
  }
  for (std::size_t i = 0; i < problem.boundary_constraints.size(); ++i) {
    check_constraint(problem, fmt::format("boundary_constraints[{}]", i), problem.boundary_constraints[i]);
  }
  check_rotations(problem);
  check_start(problem);
  check_cycle(problem);
  check_cost("running_cost", problem.robot, problem.running_cost);
  check_cost("terminal_cost", problem.robot, problem.terminal_cost);
  check_weightless("terminal_cost.acceleration_weight", problem.terminal_cost.acceleration_weight);
  check_weightless("terminal_cost.torque_weight", problem.terminal_cost.torque_weight);
  check_weightless("terminal_cost.force_weight", problem.terminal_cost.force_weight);
  check_weightless("terminal_cost.time_weight", VectorXd::Constant(1, problem.terminal_cost.time_weight));
  check_tolerance("position", problem.goal_tolerance.position);
  check_tolerance("angle", problem.goal_tolerance.angle);
  check_tolerance("velocity", problem.goal_tolerance.velocity);
  check_terms(problem);
}

}  // namespace prowl
