#include "prowl/diagnosis/asked_parameters.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <optional>

#include "prowl/dynamics/rigid_body_terms.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/model/so3.hpp"
#include "prowl/motion/contact_schedule.hpp"
#include "prowl/transcription/node/motion_limit.hpp"

namespace prowl {

namespace {

using Eigen::Index;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// The goal at that part of its distance from the start: pose, joints and velocities; not torques.
BoundaryConstraint nearer(const MotionProblem& problem, BoundaryConstraint goal, double part) {
  const VectorXd& start = problem.start_configuration();
  const int nu = problem.robot.nu();
  goal.q_ref.head<3>() = start.head<3>() + part * (goal.q_ref - start).head<3>();
  goal.q_ref.tail(nu) = start.tail(nu) + part * (goal.q_ref - start).tail(nu);
  const Eigen::Matrix3d from = base_rotation(start);
  const Vector3d turn = so3::log(from.transpose() * base_rotation(goal.q_ref));
  set_base_rotation(goal.q_ref, from * so3::exp(part * turn));
  for (int i = 0; i < problem.robot.nv(); ++i) {
    if (i >= 3 && i < 6) continue;  // bounds on a rotation keep their width
    goal.configuration_lower(i) *= part;
    goal.configuration_upper(i) *= part;
  }
  goal.velocity_lower *= part;
  goal.velocity_upper *= part;
  return goal;
}

/// An entry of a goal, and its distance from the start in its unit.
struct Away {
  MotionLimit entry;
  double off = 0.0;
  std::optional<double> at = {};  ///< target of the coordinate, if it has one
  int entries = 0;                ///< number of entries away from the start
};

/// The farthest entry, relative to its size; off = 0 if none is away.
Away farthest(const MotionProblem& problem, const BoundaryConstraint& goal) {
  const RobotModel& robot = problem.robot;
  const VectorXd& start = problem.start_configuration();
  Away most;
  const auto look = [&most](const MotionLimit& entry, double lower, double upper, std::optional<double> from = {}) {
    const double off = lower > 0.0 ? lower : upper < 0.0 ? upper : 0.0;
    if (off == 0.0 || !std::isfinite(off)) return;
    const int entries = most.entries + 1;
    if (std::abs(off) / entry.size > std::abs(most.off) / most.entry.size + 1e-9)
      most = {entry, off, from ? std::optional(*from + off) : from};
    most.entries = entries;
  };
  for (int i = 0; i < robot.nv(); ++i) {
    if (i >= 3 && i < 6) continue;
    const Index at = i < 3 ? i : i + 1;  // a configuration has a quaternion where its tangent has a rotation
    const double shift = goal.q_ref(at) - start(at);
    look(limit_of_goal(robot, goal.name, i, false), shift + goal.configuration_lower(i),
         shift + goal.configuration_upper(i), start(at));
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

AdjustableParameter goal_parameter(const MotionProblem& problem, std::size_t constraint, const Away& away) {
  return {.kind = "goal",
          .phase = problem.boundary_constraints[constraint].at.phase,
          .subject = away.entry.subject,
          .most = kMostOfWay,
          .is_asked = true,
          .weight = kWeightOfWay,
          .unit = away.entry.unit,
          .value = [off = away.off](double a) { return off * std::exp(-a); },
          .problem =
              [&problem, constraint](double a) {
                MotionProblem changed = problem;
                changed.boundary_constraints[constraint] =
                    nearer(problem, problem.boundary_constraints[constraint], std::exp(-a));
                return changed;
              },
          .words =
              [away](double a) {
                const double off = away.off * std::exp(-a);
                if (!away.at) return fmt::format("{:.3g} {}", off, away.entry.unit);
                const double at = *away.at - away.off + off;
                return fmt::format("{:.6g} {unit} ({:.3g} {unit} from the start)", at, off,
                                   fmt::arg("unit", away.entry.unit));
              },
          .besides =
              [away](double a) {
                return away.entries > 1 ? fmt::format("the whole goal {:.3g} times as far from the start", std::exp(-a))
                                        : "";
              }};
}

/// A place brought nearer to where its contact was at the start or before it opened.
AdjustableParameter foothold_parameter(const MotionProblem& problem, int phase, std::size_t held,
                                       const Vector3d& from) {
  const PhaseContact& contact = problem.phases[phase].contacts[held];
  const Surface& surface = problem.surfaces[contact.surface];
  const Vector3d to = *contact.foothold;
  const Vector3d root = from - (from - to).dot(surface.normal) * surface.normal;  // projected on the surface
  const auto foothold = [root, to](double a) -> Vector3d { return root + std::exp(-a) * (to - root); };
  return {.kind = "place",
          .phase = phase,
          .subject = problem.robot.contacts()[contact.contact].name,
          .most = kMostOfWay,
          .is_asked = true,
          .weight = kWeightOfWay,
          .unit = "m",
          .value = [root, to](double a) { return std::exp(-a) * (to - root).norm(); },
          .problem =
              [&problem, phase, held, foothold](double a) {
                MotionProblem changed = problem;
                changed.phases[phase].contacts[held].foothold = foothold(a);
                return changed;
              },
          .words =
              [foothold, root](double a) {
                const Vector3d at = foothold(a);
                constexpr double kRounding = 1e-9;  // [m]; avoids -0 from the projection
                const Vector3d shown = (at.array().abs() < kRounding).select(0.0, at);
                return fmt::format("[{:.6g}] m ({:.3g} m from its previous position)", fmt::join(shown, ", "),
                                   (at - root).norm());
              }};
}

AdjustableParameter clearance_parameter(const MotionProblem& problem) {
  return {.kind = "clearance",
          .subject = "",
          .most = kMostAmount,
          .is_asked = true,
          .weight = kWeightOfWay,
          .unit = "m",
          .value = [&problem](double a) { return problem.swing_clearance * std::exp(-a); },
          .problem =
              [&problem](double a) {
                MotionProblem changed = problem;
                changed.swing_clearance *= std::exp(-a);
                return changed;
              }};
}

void add_footholds(const MotionProblem& problem, std::vector<AdjustableParameter>& parameters) {
  const ContactSchedule schedule(problem);
  RigidBodyTerms terms(problem.robot);
  terms.update_kinematics(problem.start_configuration());
  for (int p = 1; p < static_cast<int>(problem.phases.size()); ++p) {
    const auto& contacts = problem.phases[p].contacts;
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      if (!contacts[i].foothold || !schedule.lands(p, static_cast<int>(i))) continue;
      std::optional<Vector3d> from = terms.contact_position(contacts[i].contact);
      for (const ContactStance& stance : schedule.stances()) {
        if (stance.contact == contacts[i].contact && stance.last_phase < p && stance.lands()) from = stance.foothold;
      }
      if (from) parameters.push_back(foothold_parameter(problem, p, i, *from));
    }
  }
}

}  // namespace

std::vector<AdjustableParameter> asked_parameters(const MotionProblem& problem) {
  std::vector<AdjustableParameter> parameters;
  for (std::size_t c = 1; c < problem.boundary_constraints.size(); ++c) {
    const Away away = farthest(problem, problem.boundary_constraints[c]);
    if (away.off != 0.0) parameters.push_back(goal_parameter(problem, c, away));
  }
  add_footholds(problem, parameters);
  if (problem.phases.size() > 1 && problem.swing_clearance > 0.0) parameters.push_back(clearance_parameter(problem));
  return parameters;
}

}  // namespace prowl
