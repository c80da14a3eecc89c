#include "prowl/task_file/task_goals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "prowl/model/configuration.hpp"
#include "prowl/model/so3.hpp"
#include "prowl/task_file/task_moment.hpp"

namespace prowl {
namespace {

/// Reads bounds of three entries, minus `origin`, into rows first ... first + 2 of lower and upper.
void read_bounds3(const TomlValue& value, const Eigen::Vector3d& origin, int first, Eigen::VectorXd& lower,
                  Eigen::VectorXd& upper) {
  const std::vector<TomlValue> entries = value.as_list(3);
  for (int i = 0; i < 3; ++i) {
    const TomlBounds bounds = entries[i].as_bounds();
    lower(first + i) = bounds.lower - origin(i);
    upper(first + i) = bounds.upper - origin(i);
  }
}

/// Limits of all joints.
struct JointRange {
  Eigen::VectorXd lower, upper;  ///< nu
  const char* name;
};

/// Reads bounds of the named joints, minus `origin` (nu), into the last nu rows of lower and upper.
void read_joint_bounds(const TomlValue& value, const RobotModel& robot, const JointRange& range,
                       const Eigen::VectorXd& origin, Eigen::VectorXd& lower, Eigen::VectorXd& upper) {
  constexpr double kRounding = 1e-9;  // [rad, m, rad/s, m/s, N m]
  const std::vector<std::string>& names = robot.joint_names();
  const Eigen::Index first = lower.size() - robot.nu();
  for (const auto& [name, entry] : value.as_named_values(names, "joint")) {
    const Eigen::Index joint = std::find(names.begin(), names.end(), name) - names.begin();
    const TomlBounds bounds = entry.as_bounds();
    if (bounds.lower > range.upper(joint) + kRounding || bounds.upper < range.lower(joint) - kRounding) {
      entry.fail(fmt::format("outside the joint's {} limits; need a value from {:.5g} to {:.5g}", range.name,
                             range.lower(joint), range.upper(joint)));
    }
    lower(first + joint) = bounds.lower - origin(joint);
    upper(first + joint) = bounds.upper - origin(joint);
  }
}

void read_base_position(const TomlTable& goal, const TaskStart& start, BoundaryConstraint& constraint) {
  const auto position = goal.find("base_position_m");
  const auto displacement = goal.find("base_displacement_m");
  if (position && displacement) displacement->fail("need either base_position_m or base_displacement_m, not both");
  if (!position && !displacement) return;
  const Eigen::Vector3d origin = position ? base_position(start.q) : Eigen::Vector3d::Zero();
  Eigen::VectorXd lower(3), upper(3);
  read_bounds3(position ? *position : *displacement, origin, 0, lower, upper);
  for (int i = 0; i < 3; ++i) {
    // A prescribed component becomes part of q_ref, the pose that the initial guess goes to.
    const double shift = lower(i) == upper(i) ? lower(i) : 0.0;
    constraint.q_ref(i) += shift;
    constraint.configuration_lower(i) = lower(i) - shift;
    constraint.configuration_upper(i) = upper(i) - shift;
  }
}

void read_base_orientation(const TomlValue& value, const TaskStart& start, BoundaryConstraint& constraint) {
  const std::vector<TomlValue> entries = value.as_list(3);
  Eigen::Vector3d rpy = start.rpy;
  for (int i = 0; i < 3; ++i) {
    const TomlValue& entry = entries[i];
    if (entry.is_text() && entry.as_text() == "free") continue;
    if (!entry.node().is_number()) entry.fail("need a finite number [rad] or \"free\"");
    rpy(i) = entry.as_number();
    constraint.configuration_lower(3 + i) = constraint.configuration_upper(3 + i) = 0.0;
  }
  set_base_rotation(constraint.q_ref, rotation_from_rpy(rpy));
}

bool binds(const BoundaryConstraint& constraint) {
  for (const auto* bounds :
       {&constraint.configuration_lower, &constraint.configuration_upper, &constraint.velocity_lower,
        &constraint.velocity_upper, &constraint.torque_lower, &constraint.torque_upper}) {
    if (bounds->array().isFinite().any()) return true;
  }
  return false;
}

BoundaryConstraint read_goal(const TomlTable& goal, const std::string& name, const RobotModel& robot,
                             const TaskStart& start, PhaseFraction at) {
  BoundaryConstraint constraint = BoundaryConstraint::unbounded(robot, name, at, start.q);
  read_base_position(goal, start, constraint);
  if (const auto rpy = goal.find("base_rpy_rad")) read_base_orientation(*rpy, start, constraint);
  if (const auto joints = goal.find("joints")) {
    read_joint_bounds(*joints, robot, {robot.position_lower(), robot.position_upper(), "position"},
                      constraint.q_ref.tail(robot.nu()), constraint.configuration_lower,
                      constraint.configuration_upper);
  }
  if (const auto linear = goal.find("base_linear_velocity_mps")) {
    read_bounds3(*linear, Eigen::Vector3d::Zero(), 0, constraint.velocity_lower, constraint.velocity_upper);
  }
  if (const auto angular = goal.find("base_angular_velocity_radps")) {
    read_bounds3(*angular, Eigen::Vector3d::Zero(), 3, constraint.velocity_lower, constraint.velocity_upper);
  }
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(robot.nu());
  if (const auto rates = goal.find("joint_velocity_radps")) {
    read_joint_bounds(*rates, robot, {-robot.velocity_limit(), robot.velocity_limit(), "velocity"}, zero,
                      constraint.velocity_lower, constraint.velocity_upper);
  }
  if (const auto torques = goal.find("torque_Nm")) {
    read_joint_bounds(*torques, robot, {-robot.torque_limit(), robot.torque_limit(), "torque"}, zero,
                      constraint.torque_lower, constraint.torque_upper);
  }
  if (!binds(constraint))
    goal.value().fail("constrains nothing; need at least one key that prescribes or bounds a value");
  return constraint;
}

}  // namespace

BoundaryConstraint arrival(const RobotModel& robot, const TaskStart& start, const Eigen::Vector3d& displacement,
                           const Eigen::Vector3d& rotation, int num_phases) {
  BoundaryConstraint goal =
      BoundaryConstraint::unbounded(robot, "goal 1", PhaseFraction::end_of(num_phases - 1), start.q);
  goal.q_ref.head<3>() += displacement;
  set_base_rotation(goal.q_ref, so3::exp(rotation) * base_rotation(start.q));
  goal.configuration_lower.head<6>().setZero();
  goal.configuration_upper.head<6>().setZero();
  goal.velocity_lower.head<6>().setZero();
  goal.velocity_upper.head<6>().setZero();
  return goal;
}

std::vector<BoundaryConstraint> read_goals(const TomlTable& root, const RobotModel& robot, const TaskStart& start,
                                           const std::vector<Phase>& phases, const std::optional<Mesh>& mesh) {
  std::vector<BoundaryConstraint> goals;
  for (const TomlTable& goal : root.find_tables("goal")) {
    const std::string name = fmt::format("goal {}", goals.size() + 1);
    goals.push_back(read_goal(goal, name, robot, start, read_moment(goal, phases, mesh)));
    if (std::count_if(goals.begin(), goals.end(), [&](const auto& g) { return g.at == goals.back().at; }) > 1) {
      goal.value().fail("two goals at the same time; merge them into one [[goal]]");
    }
  }
  return goals;
}

}  // namespace prowl
