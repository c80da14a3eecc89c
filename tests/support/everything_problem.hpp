#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "prowl/model/configuration.hpp"
#include "prowl/motion/motion_problem.hpp"

/// A problem that has everything at once, for tests of derivatives.
namespace prowl::test {

inline Phase phase_on(std::string name, const std::vector<int>& contacts, double duration, int intervals) {
  Phase phase{.name = std::move(name), .duration = {duration, duration}, .intervals = intervals};
  for (const int contact : contacts) phase.contacts.push_back({contact, 0});
  return phase;
}

inline BoundaryCondition fixed_start(const RobotModel& robot) {
  auto start = BoundaryCondition::unbounded(robot, "start", {0, 0}, robot.nominal_configuration());
  start.configuration_lower.setZero();
  start.configuration_upper.setZero();
  start.velocity_lower.setZero();
  start.velocity_upper.setZero();
  return start;
}

/// Every kind of cost, constraint and phase at once, with weights that are all different.
inline MotionProblem everything(RobotModel robot, const std::vector<Phase>& phases) {
  const int nv = robot.nv(), nu = robot.nu();
  MotionProblem problem{.name = "everything", .robot = std::move(robot)};
  problem.surfaces = {Surface{.normal = Eigen::Vector3d(0.1, -0.2, 1.0).normalized()}};
  problem.phases = phases;
  problem.boundary_conditions = {fixed_start(problem.robot)};
  Eigen::VectorXd displacement = Eigen::VectorXd::Zero(nv);
  displacement.head<6>() << 0.05, 0.03, -0.05, 0.3, -0.2, 0.4;
  const Eigen::VectorXd goal_q = integrate(problem.robot.nominal_configuration(), displacement);
  const int last = static_cast<int>(phases.size()) - 1;
  auto goal = BoundaryCondition::unbounded(problem.robot, "goal", {last, phases.back().intervals}, goal_q);
  goal.configuration_lower.head<6>().setZero();
  goal.configuration_upper.head<6>().setZero();
  problem.boundary_conditions.push_back(goal);

  QuadraticCost& cost = problem.running_cost;
  cost.q_ref = goal_q;
  cost.configuration_weight = Eigen::VectorXd::LinSpaced(nv, 1.0, 3.0);
  cost.velocity_weight = Eigen::VectorXd::LinSpaced(nv, 0.1, 0.5);
  cost.acceleration_weight = Eigen::VectorXd::LinSpaced(nv, 0.01, 0.02);
  cost.tau_ref = Eigen::VectorXd::Constant(nu, 3.0);
  cost.torque_weight = Eigen::VectorXd::LinSpaced(nu, 0.001, 0.002);
  cost.force_weight = Eigen::Vector3d(3e-4, 2e-4, 1e-4);
  cost.contact_positions = {{2, {0.1, 0.2, 0.3}, {4.0, 5.0, 6.0}}};
  problem.terminal_cost = cost;
  problem.terminal_cost.acceleration_weight.setZero();
  problem.terminal_cost.torque_weight.setZero();
  problem.terminal_cost.force_weight.setZero();
  problem.terminal_cost.contact_positions = {{0, {0.3, 0.2, 0.1}, {7.0, 5.0, 6.0}},
                                             {3, {0.0, 0.2, 0.1}, {1.0, 2.0, 3.0}}};
  return problem;
}

inline Phase free_phase(std::string name, const std::vector<int>& contacts, int intervals) {
  Phase phase = phase_on(std::move(name), contacts, 0.3, intervals);
  phase.duration = {0.2, 0.5};
  return phase;
}

}  // namespace prowl::test
