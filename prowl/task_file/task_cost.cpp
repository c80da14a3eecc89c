#include "prowl/task_file/task_cost.hpp"

#include <algorithm>

#include "prowl/dynamics/static_equilibrium.hpp"
#include "prowl/task_file/toml/toml_vectors.hpp"
#include "prowl/terms/torque_peaks.hpp"

namespace prowl {
namespace {

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
  Eigen::VectorXd weight = Eigen::VectorXd::Zero(3);
  read_axes(table, "weight", weight);
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

/// Keys common to both tables.
void read_state_cost(const TomlTable& table, const MotionProblem& problem, QuadraticCost& cost) {
  const RobotModel& robot = problem.robot;
  if (const auto reference = table.find("reference")) {
    const bool is_goal = reference->as_choice("reference") == "goal";
    if (is_goal) {
      if (problem.boundary_constraints.size() < 2) reference->fail("\"goal\" needs a [[goal]]");
      cost.q_ref = problem.boundary_constraints.back().q_ref;
    }
  }
  read_axes(table, "base_position", cost.configuration_weight.segment(0, 3));
  read_axes(table, "base_orientation", cost.configuration_weight.segment(3, 3));
  read_joints(table, "joint_position", robot, cost.configuration_weight.tail(robot.nu()));
  read_axes(table, "base_linear_velocity", cost.velocity_weight.segment(0, 3));
  read_axes(table, "base_angular_velocity", cost.velocity_weight.segment(3, 3));
  read_joints(table, "joint_velocity", robot, cost.velocity_weight.tail(robot.nu()));
  for (const TomlTable& entry : table.find_tables("contact_position")) {
    cost.contact_positions.push_back(read_contact_position(entry, robot));
  }
}

/// Torques that hold the start posture on the contacts of the first phase.
Eigen::VectorXd static_torque(const MotionProblem& problem) {
  const std::vector<int> contacts = contact_indices(problem.phases.front().contacts);
  return static_equilibrium(problem.robot, problem.start_configuration(), contacts).tau;
}

void read_running_cost(const TomlTable& table, const MotionProblem& problem, QuadraticCost& cost) {
  const RobotModel& robot = problem.robot;
  read_state_cost(table, problem, cost);
  read_axes(table, "base_linear_acceleration", cost.acceleration_weight.segment(0, 3));
  read_axes(table, "base_angular_acceleration", cost.acceleration_weight.segment(3, 3));
  read_joints(table, "joint_acceleration", robot, cost.acceleration_weight.tail(robot.nu()));
  read_joints(table, "torque", robot, cost.torque_weight);
  if (const auto time = table.find("time")) cost.time_weight = time->as_number();
  Eigen::VectorXd force = cost.force_weight;
  read_axes(table, "force", force);
  cost.force_weight = force;

  const auto reference = table.find("torque_reference");
  const bool is_static = !reference || reference->as_choice("torque reference") == "static";
  if (is_static) cost.tau_ref = static_torque(problem);
}

/// peak_torque: a term over the whole motion.
void read_peak_torque(const TomlTable& table, MotionProblem& problem) {
  const auto weight = table.find("peak_torque");
  if (!weight || weight->as_number() == 0.0) return;
  TermUse use{.name = "peak_torque",
              .term = torque_peaks(problem.robot),
              .from = PhaseFraction::start_of(0),
              .to = PhaseFraction::end_of(static_cast<int>(problem.phases.size()) - 1)};
  use.reference.setZero(problem.robot.nu());
  use.weight = weight->as_number() * Eigen::MatrixXd::Identity(problem.robot.nu(), problem.robot.nu());
  problem.terms.push_back(std::move(use));
}

}  // namespace

void read_costs(const TomlTable& root, MotionProblem& problem) {
  problem.running_cost = no_cost(problem);
  problem.terminal_cost = no_cost(problem);
  if (const auto table = root.find_table("cost")) {
    read_running_cost(*table, problem, problem.running_cost);
    read_peak_torque(*table, problem);
  }
  if (const auto table = root.find_table("terminal_cost")) read_state_cost(*table, problem, problem.terminal_cost);
}

}  // namespace prowl
