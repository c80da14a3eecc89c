#include "prowl/task_file/task_gait.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "prowl/dynamics/inverse_kinematics.hpp"
#include "prowl/dynamics/rigid_body_terms.hpp"
#include "prowl/mesh/mesh.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/motion/gait.hpp"

namespace prowl {
namespace {

constexpr double kSteepest = 0.1;  // z of the normal: 84 degrees of slope

Feet need_feet(const TomlTable& table, const RobotModel& robot) {
  if (const auto feet = find_feet(robot)) return *feet;
  table.value().fail(
      fmt::format("a gait needs four contacts: fore left, fore right, hind left and hind right in the nominal posture; "
                  "the {} of {} differ: write the phases as [[phase]]",
                  robot.contacts().size(), robot.name()));
}

int read_surface(const TomlTable& table, const std::vector<Surface>& surfaces) {
  std::vector<std::string> names;
  for (const Surface& surface : surfaces) names.push_back(surface.name);
  const auto value = table.find("surface");
  const std::size_t index = value ? value->as_one_of("surface", names) : 0;
  if (surfaces[index].normal.z() < kSteepest) {
    (value ? *value : table.value())
        .fail("surface '" + names[index] + "' is too steep to walk on; need its normal upward");
  }
  return static_cast<int>(index);
}

Gait read_values(const TomlTable& table, const RobotModel& robot, const std::vector<Surface>& surfaces) {
  Gait gait;
  gait.pattern = gait_pattern(table.need("kind").as_choice("gait"));
  gait.strides = table.need("strides").as_integer();
  const auto speed = table.find("speed_mps"), stride = table.find("stride_s");
  const double height = robot.nominal_configuration()(2);
  const double given_speed = speed ? speed->as_number() : 0.0;
  if (const auto length = table.find("stride_length_m"); speed && length)
    length->fail("gait.speed_mps sets the length of a stride, too; need one of the two");
  const double usual = gait.pattern.default_stride(height, given_speed);
  gait.stride = {usual, usual};
  if (stride) {
    const TomlBounds bounds = stride->as_range();
    gait.stride = {bounds.lower, bounds.upper};
  }
  const auto duty_factor = table.find("duty_factor");
  gait.duty_factor = duty_factor ? duty_factor->as_number() : gait.pattern.default_duty_factor(height, given_speed);
  if (const auto value = table.find("start_s")) gait.start = value->as_number();
  if (const auto value = table.find("settle_s")) gait.settle = value->as_number();
  gait.surface = read_surface(table, surfaces);
  return gait;
}

/// Reads intervals_per_second [1/s], for phases at their longest; nullopt if the file does not say.
std::optional<double> read_intervals_per_second(const TomlTable& table, const Gait& gait) {
  const auto value = table.find("intervals_per_second");
  if (!value) return std::nullopt;
  const double rate = value->as_number();
  const double seconds = gait.start + gait.strides * gait.stride.max + gait.settle;
  if (const double intervals = seconds * rate; intervals > kMostIntervals) {
    table.value().fail(fmt::format("{:.0f} mesh intervals, {:g} s of {:g} a second, are not allowed; need at most {}",
                                   intervals, seconds, rate, kMostIntervals));
  }
  return rate;
}

/// Angle by which all strides turn the base [rad].
double read_turn(const TomlTable& table, const Gait& gait) {
  constexpr double kMostTurned = 3.0;  // [rad]; further round, the shortest way to the end orientation is the other one
  const auto value = table.find("turn_rad");
  const double turn = value ? gait.strides * value->as_number() : 0.0;
  if (std::abs(turn) > kMostTurned) {
    value->fail(fmt::format("{} strides turn the base by {:.3g} rad; need at most {:g} in all", gait.strides, turn,
                            kMostTurned));
  }
  return turn;
}

/// Distance along the surface in a stride [m].
double read_stride_length(const TomlTable& table, const Gait& gait) {
  const auto speed = table.find("speed_mps");
  return speed ? speed->as_number() * 0.5 * (gait.stride.min + gait.stride.max)
               : table.need("stride_length_m").as_number();
}

double read_heading(const TomlTable& table, const TaskStart& start) {
  const auto heading = table.find("heading_rad");
  return heading ? heading->as_number() : start.rpy.z();
}

std::optional<Travel> read_travel(const TomlTable& root, const TomlTable& table, const Gait& gait,
                                  const Surface& surface, const TaskStart& start) {
  if (root.find("goal")) {
    for (const char* key : {"stride_length_m", "speed_mps", "heading_rad", "turn_rad"}) {
      if (const auto value = table.find(key)) {
        value->fail("has no effect beside [[goal]], which sets the target; need one of the two");
      }
    }
    return std::nullopt;
  }
  const double length = gait.strides * read_stride_length(table, gait), turn = read_turn(table, gait);
  return Travel{along_arc(surface, read_heading(table, start), length, turn), turn * surface.normal};
}

/// Strides that repeat: each foot stands around the place under its hip in the middle of its stance.
TaskGait read_cycle(const TomlTable& root, const TomlTable& table, const Gait& gait, const RobotModel& robot,
                    const Feet& feet, const Surface& surface, const TaskStart& start) {
  if (gait.duty_factor <= gait.pattern.least_duty_factor()) {
    table.need("periodic")
        .fail(fmt::format("a duty factor of {:g} leaves no time in which all feet stand; need one above {:g}",
                          gait.duty_factor, gait.pattern.least_duty_factor()));
  }
  if (const auto goals = root.find("goal")) goals->fail("has no effect beside gait.periodic; need one of the two");
  for (const char* key : {"start_s", "settle_s"}) {
    if (const auto value = table.find(key)) value->fail("has no effect beside gait.periodic; need one of the two");
  }
  const auto is_left = [](const auto& choice) { return choice.has_value(); };
  if (std::ranges::any_of(start.pose, is_left) || std::ranges::any_of(start.speed, is_left) || !start.v.isZero(0.0))
    root.need("start").fail(
        "ranges and velocities have no effect beside gait.periodic, which finds both; need a fixed pose");
  const double heading = read_heading(table, start), length = read_stride_length(table, gait);
  const auto turn_key = table.find("turn_rad");
  const double turn = turn_key ? turn_key->as_number() : 0.0;
  if (turn != 0.0 && surface.normal != Eigen::Vector3d::UnitZ())
    turn_key->fail("strides that repeat turn on level ground only; need 0");

  // What takes the base from its start along the arc by `strides`, also a part of one or backwards.
  const Eigen::Vector3d origin = base_position(start.q);
  const auto way = [&](double strides) {
    Cycle part{1, along_arc(surface, heading, strides * length, strides * turn), strides * turn};
    part.displacement += origin - part.rotation() * origin;
    return part;
  };
  RigidBodyTerms terms(robot);
  terms.update_kinematics(start.q);
  std::vector<ContactTarget> targets;
  for (const Foot foot : {Foot::lf, Foot::rf, Foot::lh, Foot::rh}) {
    const int contact = feet[static_cast<std::size_t>(foot)];
    targets.push_back({contact, way(middle_of_stance(gait, foot)).moved(terms.contact_position(contact))});
  }
  const InverseKinematics standing = inverse_kinematics(robot, start.q, targets);
  if (!standing.converged) {
    table.value().fail(fmt::format("the legs do not reach where strides of {:.3g} m begin; need shorter ones", length));
  }

  TaskGait result{.phases = {}, .intervals = {}, .travel = {}, .cycle = {}, .cycle_start = standing.q};
  for (int stride = 1; stride <= gait.strides; ++stride) {
    std::vector<Phase> phases = expand_cycle(gait, robot, feet, stride);
    std::vector<int> held = contact_indices(phases.back().contacts);
    for (Phase& phase : phases) {
      for (PhaseContact& contact : phase.contacts) {
        if (std::ranges::find(held, contact.contact) != held.end()) continue;
        const auto target = std::ranges::find(targets, contact.contact, &ContactTarget::contact);
        const double radius = robot.contacts()[static_cast<std::size_t>(contact.contact)].radius;
        contact.foothold = way(stride).moved(target->position) - radius * surface.normal;
      }
      held = contact_indices(phase.contacts);
      result.phases.push_back(std::move(phase));
    }
  }
  result.cycle = way(1.0);
  result.cycle->count = gait.strides;
  return result;
}

}  // namespace

std::optional<TaskGait> read_gait(const TomlTable& root, const RobotModel& robot, const std::vector<Surface>& surfaces,
                                  const TaskStart& start) {
  const auto table = root.find_table("gait");
  if (!table) return std::nullopt;
  if (root.find("phase")) table->value().fail("the file also has [[phase]]; need one of the two");
  const Feet feet = need_feet(*table, robot);
  const Gait gait = read_values(*table, robot, surfaces);
  const std::optional<double> rate = read_intervals_per_second(*table, gait);
  const Surface& surface = surfaces[static_cast<std::size_t>(gait.surface)];
  const auto periodic = table->find("periodic");
  TaskGait result =
      periodic && periodic->as_boolean()
          ? read_cycle(root, *table, gait, robot, feet, surface, start)
          : TaskGait{expand(gait, robot, feet), {}, read_travel(root, *table, gait, surface, start), {}, {}};
  if (rate) {
    for (const PhaseMesh& phase : mesh_with_rate(result.phases, *rate).phases)
      result.intervals.push_back(phase.intervals());
  }
  return result;
}

}  // namespace prowl
