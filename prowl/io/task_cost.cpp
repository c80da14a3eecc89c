#include "prowl/io/task_cost.hpp"

#include <algorithm>

#include "prowl/dynamics/static_equilibrium.hpp"

namespace prowl {
namespace {

void read_weight3(const TomlTable& table, const std::string& key, Eigen::Ref<Eigen::VectorXd> weight) {
  const auto value = table.find(key);
  if (!value) return;
  const NumberRange range = NumberRange::nonnegative();
  if (value->is_list()) {
    weight = value->as_vector3(range);
  } else {
    weight.setConstant(value->as_number(range));
  }
}

void read_joint_weight(const TomlTable& table, const std::string& key, const RobotModel& robot,
                       Eigen::Ref<Eigen::VectorXd> weight) {
  const auto value = table.find(key);
  if (!value) return;
  const NumberRange range = NumberRange::nonnegative();
  if (!value->is_table()) {
    weight.setConstant(value->as_number(range));
    return;
  }
  const std::vector<std::string>& names = robot.joint_names();
  for (const auto& [name, entry] : value->as_named_values(names, "joint")) {
    weight(std::find(names.begin(), names.end(), name) - names.begin()) = entry.as_number(range);
  }
}

ContactPositionCost read_contact_position(const TomlTable& table, const RobotModel& robot) {
  std::vector<std::string> names;
  for (const ContactPoint& contact : robot.contacts()) names.push_back(contact.name);
  ContactPositionCost cost;
  const TomlValue contact = table.need("contact");
  const auto found = std::find(names.begin(), names.end(), contact.as_text());
  if (found == names.end()) contact.fail_unknown_name("contact", names);
  cost.contact = static_cast<int>(found - names.begin());
  cost.reference = table.need("reference_m").as_vector3();
  table.need("weight");
  Eigen::VectorXd weight(3);
  read_weight3(table, "weight", weight);
  cost.weight = weight;
  return cost;
}

QuadraticCost no_cost(const MotionProblem& problem) {
  const RobotModel& robot = problem.robot;
  QuadraticCost cost;
  cost.q_ref = problem.start_configuration();
  cost.configuration_weight.setZero(robot.nv());
  cost.velocity_weight.setZero(robot.nv());
  cost.acceleration_weight.setZero(robot.nv());
  cost.tau_ref.setZero(robot.nu());
  cost.torque_weight.setZero(robot.nu());
  return cost;
}

/// The keys that both tables have.
void read_state_cost(const TomlTable& table, const MotionProblem& problem, QuadraticCost& cost) {
  const RobotModel& robot = problem.robot;
  if (const auto reference = table.find("reference")) {
    const std::vector<std::string> known = {"start", "goal"};
    const std::string name = reference->as_text();
    if (std::find(known.begin(), known.end(), name) == known.end()) reference->fail_unknown_name("reference", known);
    if (name == "goal") {
      if (problem.boundary_conditions.size() < 2) reference->fail("\"goal\" needs a [[goal]]");
      cost.q_ref = problem.boundary_conditions.back().q_ref;
    }
  }
  read_weight3(table, "base_position", cost.configuration_weight.segment(0, 3));
  read_weight3(table, "base_orientation", cost.configuration_weight.segment(3, 3));
  read_joint_weight(table, "joint_position", robot, cost.configuration_weight.tail(robot.nu()));
  read_weight3(table, "base_linear_velocity", cost.velocity_weight.segment(0, 3));
  read_weight3(table, "base_angular_velocity", cost.velocity_weight.segment(3, 3));
  read_joint_weight(table, "joint_velocity", robot, cost.velocity_weight.tail(robot.nu()));
  for (const TomlTable& place : table.find_tables("contact_position")) {
    cost.contact_positions.push_back(read_contact_position(place, robot));
  }
}

/// Torques that hold the start posture on the contacts of the first phase.
Eigen::VectorXd static_torque(const MotionProblem& problem) {
  std::vector<int> contacts;
  for (const PhaseContact& contact : problem.phases.front().contacts) contacts.push_back(contact.contact);
  return static_equilibrium(problem.robot, problem.start_configuration(), contacts).tau;
}

void read_running_cost(const TomlTable& table, const MotionProblem& problem, QuadraticCost& cost) {
  const RobotModel& robot = problem.robot;
  read_state_cost(table, problem, cost);
  read_weight3(table, "base_linear_acceleration", cost.acceleration_weight.segment(0, 3));
  read_weight3(table, "base_angular_acceleration", cost.acceleration_weight.segment(3, 3));
  read_joint_weight(table, "joint_acceleration", robot, cost.acceleration_weight.tail(robot.nu()));
  read_joint_weight(table, "torque", robot, cost.torque_weight);
  if (const auto time = table.find("time")) cost.time_weight = time->as_number(NumberRange::nonnegative());
  Eigen::VectorXd force = cost.force_weight;
  read_weight3(table, "force", force);
  cost.force_weight = force;

  const auto reference = table.find("torque_reference");
  const std::string name = reference ? reference->as_text() : "static";
  if (name == "static") {
    cost.tau_ref = static_torque(problem);
  } else if (name != "zero") {
    reference->fail_unknown_name("torque reference", {"static", "zero"});
  }
}

}  // namespace

void read_costs(const TomlTable& root, MotionProblem& problem) {
  problem.running_cost = no_cost(problem);
  problem.terminal_cost = no_cost(problem);
  if (const auto table = root.find_table("cost")) read_running_cost(*table, problem, problem.running_cost);
  if (const auto table = root.find_table("terminal_cost")) read_state_cost(*table, problem, problem.terminal_cost);
}

}  // namespace prowl
