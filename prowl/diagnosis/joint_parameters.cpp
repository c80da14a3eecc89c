#include "prowl/diagnosis/joint_parameters.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace prowl {

namespace {

LimitCurve::Table times(LimitCurve::Table table, double factor) {
  for (auto& [at, limit] : table) limit *= factor;
  return table;
}

/// Widens both sides equally, within torque_over_position.
void widen(JointLimits& limits, double lower, double upper, double factor) {
  const double more = 0.5 * (upper - lower) * (factor - 1.0);
  limits.position_lower = lower - more;
  limits.position_upper = upper + more;
  for (const LimitCurve::Table* table : {&limits.torque_over_position, &limits.negative_torque_over_position}) {
    if (table->empty()) continue;
    limits.position_lower = std::max(*limits.position_lower, std::min(lower, table->front().first));
    limits.position_upper = std::min(*limits.position_upper, std::max(upper, table->back().first));
  }
}

MotionProblem with_joints(const MotionProblem& problem, LimitKind kind, const std::vector<int>& joints, double factor) {
  const RobotModel& robot = problem.robot;
  RobotDescription description = robot.description();
  for (const int j : joints) {
    JointLimits& limits = description.limits[robot.joint_names()[j]];
    if (kind == LimitKind::torque) {
      if (std::isfinite(robot.torque_limit()(j))) limits.torque = factor * robot.torque_limit()(j);
      limits.torque_over_position = times(limits.torque_over_position, factor);
      limits.negative_torque_over_position = times(limits.negative_torque_over_position, factor);
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

/// Keys of the robot file that scale with the torque limits of these joints.
std::string tables_with_torque(const RobotModel& robot, const std::vector<int>& joints, double factor) {
  std::set<std::string> tables;
  for (const RobotModel::TorqueCurve& curve : robot.torque_curves()) {
    if (std::ranges::find(joints, curve.joint) == joints.end()) continue;
    tables.insert(curve.over_velocity ? "torque_over_velocity" : "torque_over_position");
    if (!robot.description().limits.at(robot.joint_names()[curve.joint]).negative_torque_over_position.empty())
      tables.insert("negative_torque_over_position");
  }
  return tables.empty() ? "" : fmt::format("and {} times {:.5g}", fmt::join(tables, " and "), factor);
}

/// Joints whose ranges widen by less than the factor because torque_over_position ends, with these ranges.
std::string narrower_ranges(const MotionProblem& problem, const std::vector<int>& joints, double factor) {
  constexpr double kRounding = 1e-9;
  const RobotModel wider = with_joints(problem, LimitKind::joint_position, joints, factor).robot;
  std::vector<std::string> ranges;
  for (const int j : joints) {
    const double width = value_of_limit(problem.robot, LimitKind::joint_position, j);
    if (value_of_limit(wider, LimitKind::joint_position, j) >= factor * width * (1.0 - kRounding)) continue;
    ranges.push_back(fmt::format("{} {}", problem.robot.joint_names()[j], range_of(wider, j)));
  }
  return ranges.empty() ? "" : fmt::format("but within torque_over_position {}", fmt::join(ranges, ", "));
}

}  // namespace

double value_of_limit(const RobotModel& robot, LimitKind kind, int joint) {
  if (kind == LimitKind::torque) return robot.torque_limit()(joint);
  if (kind == LimitKind::joint_velocity) return robot.velocity_limit()(joint);
  return robot.position_upper()(joint) - robot.position_lower()(joint);
}

std::vector<int> turnable_joints(const RobotModel& robot, LimitKind kind) {
  std::vector<int> joints;
  for (int j = 0; j < robot.nu(); ++j) {
    const bool has_curve = std::ranges::any_of(
        robot.torque_curves(), [j](const auto& curve) { return curve.joint == j && curve.over_velocity; });
    if (kind != LimitKind::joint_velocity || !has_curve) joints.push_back(j);
  }
  return joints;
}

AdjustableParameter joint_parameter(const MotionProblem& problem, LimitKind kind, const std::vector<int>& joints) {
  const RobotModel& robot = problem.robot;
  const int first = joints.front();
  const auto range = [&problem, kind, joints, first](double a) {
    return range_of(with_joints(problem, kind, joints, std::exp(a)).robot, first);
  };
  std::vector<std::string> names;
  for (const int j : joints) names.push_back(robot.joint_names()[j]);
  const bool several = joints.size() > 1;  // their limits may differ, so they share a factor
  const bool all = several && static_cast<int>(joints.size()) == robot.nu();
  return {.kind = to_string(kind),
          .subject = all ? "" : fmt::format("{}", fmt::join(names, ", ")),
          .most = kMostAmount,
          .is_factor = several,
          .unit = several ? "" : limit_of_joint(robot, kind, first).unit,
          .value =
              [&problem, kind, joints, several, first](double a) {
                return several ? std::exp(a)
                               : value_of_limit(with_joints(problem, kind, joints, std::exp(a)).robot, kind, first);
              },
          .problem = [&problem, kind, joints](double a) { return with_joints(problem, kind, joints, std::exp(a)); },
          .words = several || kind != LimitKind::joint_position ? std::function<std::string(double)>() : range,
          .besides =
              [&problem, kind, joints, several](double a) {
                if (kind == LimitKind::torque) return tables_with_torque(problem.robot, joints, std::exp(a));
                return several && kind == LimitKind::joint_position ? narrower_ranges(problem, joints, std::exp(a))
                                                                    : "";
              }};
}

std::vector<AdjustableParameter> joint_parameters(const MotionProblem& problem) {
  std::vector<AdjustableParameter> parameters;
  for (const LimitKind kind : {LimitKind::torque, LimitKind::joint_velocity, LimitKind::joint_position}) {
    const std::vector<int> joints = turnable_joints(problem.robot, kind);
    if (!joints.empty()) parameters.push_back(joint_parameter(problem, kind, joints));
  }
  return parameters;
}

}  // namespace prowl
