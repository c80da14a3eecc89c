#pragma once

#include <Eigen/Geometry>
#include <string>
#include <utility>
#include <vector>

#include "prowl/model/configuration.hpp"
#include "prowl/motion/motion_problem.hpp"
#include "tests/support/meshed_problem.hpp"

/// A problem that has everything at once, for tests of derivatives.
namespace prowl::test {

struct MeshedPhase {
  Phase phase;
  PhaseMesh mesh;
};

/// On the first surface, in equal intervals.
inline MeshedPhase phase_on(std::string name, const std::vector<int>& contacts, double duration, int intervals) {
  Phase phase{.name = std::move(name), .duration = {duration, duration}};
  for (const int contact : contacts) phase.contacts.push_back({contact, 0});
  return {std::move(phase), PhaseMesh(intervals)};
}

inline MeshedPhase free_phase(std::string name, const std::vector<int>& contacts, int intervals) {
  MeshedPhase free = phase_on(std::move(name), contacts, 0.3, intervals);
  free.phase.duration = {0.2, 0.5};
  return free;
}

/// At rest in the nominal posture, turned with the ground, which goes through the origin.
inline BoundaryConstraint fixed_start(const RobotModel& robot, const Surface& ground) {
  const Eigen::Matrix3d turn =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), ground.normal).toRotationMatrix();
  Eigen::VectorXd q = robot.nominal_configuration();
  q.head<3>() = (turn * q.head<3>()).eval();
  set_base_rotation(q, turn * base_rotation(robot.nominal_configuration()));
  auto start = BoundaryConstraint::unbounded(robot, "start", PhaseFraction::start_of(0), q);
  start.configuration_lower.setZero();
  start.configuration_upper.setZero();
  start.velocity_lower.setZero();
  start.velocity_upper.setZero();
  return start;
}

inline Surface tilted_ground() { return {.normal = Eigen::Vector3d(0.1, -0.2, 1.0).normalized()}; }

/// Every kind of cost, constraint and phase at once, with weights that are all different.
inline MeshedProblem everything(RobotModel robot, const std::vector<MeshedPhase>& phases,
                                const Surface& ground = tilted_ground()) {
  const int nv = robot.nv(), nu = robot.nu();
  MotionProblem problem{.name = "everything", .robot = std::move(robot)};
  Mesh mesh;
  for (const MeshedPhase& one : phases) {
    problem.phases.push_back(one.phase);
    mesh.phases.push_back(one.mesh);
  }
  problem.surfaces = {ground};
  problem.boundary_constraints = {fixed_start(problem.robot, ground)};
  Eigen::VectorXd displacement = Eigen::VectorXd::Zero(nv);
  displacement.head<6>() << 0.05, 0.03, -0.05, 0.3, -0.2, 0.4;
  const Eigen::VectorXd goal_q = integrate(problem.start_configuration(), displacement);
  const int last = static_cast<int>(phases.size()) - 1;
  auto goal = BoundaryConstraint::unbounded(problem.robot, "goal", PhaseFraction::end_of(last), goal_q);
  goal.configuration_lower.head<6>().setZero();
  goal.configuration_upper.head<6>().setZero();
  problem.boundary_constraints.push_back(goal);

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
  return {std::move(problem), std::move(mesh)};
}

}  // namespace prowl::test
