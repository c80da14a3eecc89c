#include "prowl/task_file/task_gait.hpp"

#include <fmt/format.h>

#include <cmath>

#include "prowl/mesh/mesh.hpp"
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
  const auto speed = table.find("speed_mps");
  const double length = speed ? speed->as_number() * 0.5 * (gait.stride.min + gait.stride.max)
                              : table.need("stride_length_m").as_number();
  const auto heading = table.find("heading_rad");
  const double turn = read_turn(table, gait);
  return Travel{along_arc(surface, heading ? heading->as_number() : start.rpy.z(), gait.strides * length, turn),
                turn * surface.normal};
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
  std::vector<Phase> phases = expand(gait, robot, feet);
  std::vector<int> intervals;
  if (rate) {
    for (const PhaseMesh& phase : mesh_with_rate(phases, *rate).phases) intervals.push_back(phase.intervals());
  }
  return TaskGait{std::move(phases), std::move(intervals),
                  read_travel(root, *table, gait, surfaces[gait.surface], start)};
}

}  // namespace prowl
