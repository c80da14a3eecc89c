#include "prowl/starter/new_task.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "prowl/dynamics/inverse_kinematics.hpp"
#include "prowl/dynamics/static_equilibrium.hpp"
#include "prowl/error.hpp"
#include "prowl/linear_algebra/factorisations.hpp"
#include "prowl/model/all_contacts.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/model/leg_kinematics.hpp"
#include "prowl/motion/gait.hpp"
#include "prowl/starter/rounding.hpp"

namespace prowl {
namespace {

// Shares of the standing height, from the shipped tasks for HyQ, Go2, Solo12 and Talos.
constexpr double kDepth = 0.25, kDepthOnSoles = 0.12;
constexpr double kStep = 0.2, kStepOnSoles = 0.1;
constexpr double kShift[] = {0.08, 0.045, -0.08}, kShiftOnSoles[] = {0.02, 0.02, -0.05};
constexpr double kTurn[] = {0.05, 0.1, 0.1}, kTurnOnSoles[] = {0.0, 0.0, 0.05};  // [rad]
constexpr double kSmaller = 0.8, kSmallest = 0.1;                                // factor per try, smallest factor
constexpr double kInside = 0.05;                                                 // [rad], from the limits
constexpr double kTorqueShare = 0.8;                                             // of the limits, at rest
constexpr double kFitted = 1e-6, kFittedSoles = 1e-4;  // [m]: soles are level only to rounding
constexpr double kUnbalanced = 0.01;                   // of the weight

// The torque weight scales with 1 / mass^2: docs/adding-a-robot.md. Values of HyQ's and Talos's
// tasks.
constexpr double kHyqMass = 86.8, kHyqWeight = 1e-5, kWeightOnSoles = 3e-5;

double one_digit(double x) {
  const double unit = std::pow(10.0, std::floor(std::log10(x)));
  return unit * std::max(1.0, std::round(x / unit));
}

/// Contacts at their positions in the nominal posture.
std::vector<ContactTarget> standing_targets(const RobotModel& robot) {
  const LegKinematics legs(robot);
  const Eigen::VectorXd& q = robot.nominal_configuration();
  std::vector<ContactTarget> targets;
  for (const int c : all_contacts(robot))
    targets.push_back({c, base_position(q) + base_rotation(q) * legs.position(c)});
  return targets;
}

/// True if the robot can rest with its base shifted and turned and its contacts in place.
bool can_rest(const RobotModel& robot, bool soles, const Eigen::Vector3d& shift, const Eigen::Vector3d& turn) {
  Eigen::VectorXd q = robot.nominal_configuration();
  q.head<3>() += shift;
  set_base_rotation(q, rotation_from_rpy(turn) * base_rotation(q));
  const InverseKinematics ik = inverse_kinematics(robot, q, standing_targets(robot));
  if (ik.residual > (soles ? kFittedSoles : kFitted)) return false;
  const Eigen::VectorXd joints = ik.q.tail(robot.nu());
  const Eigen::VectorXd torque = static_equilibrium(robot, ik.q, all_contacts(robot)).tau;
  for (Eigen::Index j = 0; j < robot.nu(); ++j) {
    if (std::abs(torque(j)) > kTorqueShare * robot.torque_limit()(j)) return false;
    const double start = robot.nominal_configuration()(7 + j);
    if (std::abs(joints(j) - start) < 1e-6) continue;  // unused in this motion, may be near a limit
    if (joints(j) < robot.position_lower()(j) + kInside || joints(j) > robot.position_upper()(j) - kInside)
      return false;
  }
  return true;
}

/// Largest tried factor <= 1 for which `fits` is true, if any.
template <class Fits>
std::optional<double> largest_factor(const Fits& fits) {
  for (double factor = 1.0; factor > kSmallest; factor *= kSmaller) {
    if (fits(factor)) return factor;
  }
  return std::nullopt;
}

[[noreturn]] void refuse_all_sizes(const RobotModel& robot, const char* motion) {
  throw InputError(
      fmt::format("robot '{}': found no {} within the limits, however small; see prowl robot, and choose a nominal "
                  "posture further inside the limits, or --kind hold",
                  robot.name(), motion));
}

/// Throws InputError if contacts or joints cannot carry the robot at rest in the nominal posture.
void check_that_it_stands(const RobotModel& robot) {
  const StaticEquilibrium rest = static_equilibrium(robot, robot.nominal_configuration(), all_contacts(robot));
  if (rest.residual > kUnbalanced * robot.weight()) {
    throw InputError(fmt::format(
        "robot '{}': its {} contacts cannot balance it in the nominal posture ({:.0f} N of {:.0f} N remain): "
        "a task that begins and ends at rest needs contacts around the centre of mass, three points "
        "or flat feet",
        robot.name(), robot.contacts().size(), rest.residual, robot.weight()));
  }
  for (Eigen::Index j = 0; j < robot.nu(); ++j) {
    if (std::abs(rest.tau(j)) <= kTorqueShare * robot.torque_limit()(j)) continue;
    throw InputError(fmt::format(
        "robot '{}': standing in the nominal posture takes {:.3g} of {:.3g} N m at {}: need another posture, or "
        "limits.{}.torque_Nm if that limit is not the maker's",
        robot.name(), std::abs(rest.tau(j)), robot.torque_limit()(j), robot.joint_names()[j], robot.joint_names()[j]));
  }
}

/// Contacts of one foot: those on the frame of contact `c`.
bool is_same_foot(const RobotModel& robot, std::size_t c, std::size_t other) {
  return robot.contacts()[c].frame == robot.contacts()[other].frame;
}

void check_that_it_can_step(const RobotModel& robot, const NewTask& task, int foot) {
  if (!task.soles && task.stay.size() < 3) {
    throw InputError(
        fmt::format("robot '{}': with {} lifted it stands on {} points; it needs three to be balanced, or a flat "
                    "foot; no --kind step",
                    robot.name(), task.swing.front(), task.stay.size()));
  }
  LegKinematics legs(robot);
  legs.update(robot.nominal_configuration().tail(robot.nu()));
  const Eigen::ArrayXd stretches = singular_values(legs.linear(foot));
  if ((stretches > 1e-6 * stretches(0)).count() < 3) {
    throw InputError(
        fmt::format("robot '{}': the leg of {} moves its foot in a plane only, so the weight cannot shift to the "
                    "other feet; no --kind step",
                    robot.name(), task.swing.front()));
  }
}

/// Shifts the base forward, left and down, and turns it about all axes; planar legs only as far as
/// they can.
void choose_shift(const RobotModel& robot, NewTask& task) {
  const auto& shares = task.soles ? kShiftOnSoles : kShift;
  const auto& angles = task.soles ? kTurnOnSoles : kTurn;
  const Eigen::Vector3d all_shift = task.height * Eigen::Vector3d(shares[0], shares[1], shares[2]),
                        all_turn(angles[0], angles[1], angles[2]);
  const Eigen::Vector3d everything(1.0, 1.0, 1.0), along_x(1.0, 0.0, 1.0), about_y(0.0, 1.0, 0.0),
      along_y(0.0, 1.0, 1.0), about_x(1.0, 0.0, 0.0);
  for (const auto& [shift, turn] :
       {std::pair(everything, everything), std::pair(along_x, about_y), std::pair(along_y, about_x)}) {
    const auto try_with = [&, s = shift, t = turn](double factor) {
      task.shift =
          (factor * all_shift.cwiseProduct(s)).unaryExpr([](double x) { return 1e-3 * std::round(1e3 * x) + 0.0; });
      task.turn = (factor * all_turn.cwiseProduct(t)).unaryExpr([](double x) { return hundredths(x); });
      return can_rest(robot, task.soles, task.shift, task.turn);
    };
    if (largest_factor(try_with)) return;
  }
  refuse_all_sizes(robot, "shift of the base");
}

/// Steps with the left foot; on four legs or more the left fore foot.
void choose_step(const RobotModel& robot, NewTask& task) {
  const std::vector<ContactTarget> targets = standing_targets(robot);
  std::size_t first = 0;
  const auto rank = [&](std::size_t c) {
    return targets[c].position.y() + (task.soles ? 0.0 : targets[c].position.x());
  };
  for (std::size_t c = 1; c < targets.size(); ++c) {
    if (rank(c) > rank(first)) first = c;
  }
  while (first > 0 && is_same_foot(robot, first, first - 1)) --first;
  for (std::size_t c = 0; c < targets.size(); ++c) {
    (is_same_foot(robot, c, first) ? task.swing : task.stay).push_back(robot.contacts()[c].name);
  }
  check_that_it_can_step(robot, task, static_cast<int>(first));
  task.length = hundredths((task.soles ? kStepOnSoles : kStep) * task.height);
  task.foothold = targets[first].position + Eigen::Vector3d(task.length, 0.0, 0.0);
  task.foothold.z() = 0.0;
}

constexpr double kGaitSpeed = 0.15;      // of sqrt(gravity height)
constexpr double kHyqGaitWeight = 1e-4;  // of torques

void choose_gait(const RobotModel& robot, const std::string& pattern, NewTask& task) {
  if (!find_feet(robot)) {
    throw InputError(fmt::format(
        "robot '{}': a gait needs four contacts: fore left, fore right, hind left and hind right; this robot "
        "has {}; no --kind {}",
        robot.name(), robot.contacts().size(), pattern));
  }
  task.pattern = pattern;
  task.speed = hundredths(kGaitSpeed * std::sqrt(RobotModel::kGravity * task.height));
  task.torque_weight = one_digit(kHyqGaitWeight * std::pow(kHyqMass / robot.mass(), 2));
}

const std::vector<std::pair<std::string, NewTaskKind>>& standing_kinds() {
  static const std::vector<std::pair<std::string, NewTaskKind>> kinds = {{"hold", NewTaskKind::hold},
                                                                         {"stand", NewTaskKind::stand},
                                                                         {"crouch", NewTaskKind::crouch},
                                                                         {"step", NewTaskKind::step}};
  return kinds;
}

NewTaskKind kind_of(const std::string& name) {
  const auto found = std::ranges::find(standing_kinds(), name, [](const auto& kind) { return kind.first; });
  return found == standing_kinds().end() ? NewTaskKind::gait : found->second;
}

}  // namespace

std::vector<std::string> new_task_kinds() {
  std::vector<std::string> names;
  for (const auto& [name, kind] : standing_kinds()) names.push_back(name);
  for (const GaitPattern& pattern : gait_patterns()) names.push_back(pattern.name);
  return names;
}

std::string kind_name(const NewTask& task) {
  const auto found = std::ranges::find(standing_kinds(), task.kind, [](const auto& kind) { return kind.second; });
  return found == standing_kinds().end() ? task.pattern : found->first;
}

NewTask new_task(const RobotModel& robot, const std::string& name) {
  const NewTaskKind kind = kind_of(name);
  NewTask task;
  task.kind = kind;
  task.height = robot.nominal_configuration()(2);
  for (std::size_t c = 1; c < robot.contacts().size(); ++c) task.soles = task.soles || is_same_foot(robot, c, c - 1);
  task.torque_weight = one_digit((task.soles ? kWeightOnSoles : kHyqWeight) * std::pow(kHyqMass / robot.mass(), 2));

  check_that_it_stands(robot);
  if (kind == NewTaskKind::crouch) {
    const double depth = (task.soles ? kDepthOnSoles : kDepth) * task.height;
    const auto factor = largest_factor(
        [&](double f) { return can_rest(robot, task.soles, {0.0, 0.0, -f * depth}, Eigen::Vector3d::Zero()); });
    if (!factor) refuse_all_sizes(robot, "crouch");
    task.depth = std::max(0.01, 0.01 * std::floor(100.0 * *factor * depth));
  }
  if (kind == NewTaskKind::stand && robot.contacts().size() < 3) {
    throw InputError(
        fmt::format("robot '{}': with a shifted base it falls over on {} points; no --kind stand, use hold or crouch",
                    robot.name(), robot.contacts().size()));
  }
  if (kind == NewTaskKind::stand) choose_shift(robot, task);
  if (kind == NewTaskKind::step) choose_step(robot, task);
  if (kind == NewTaskKind::gait) choose_gait(robot, name, task);
  return task;
}

}  // namespace prowl
