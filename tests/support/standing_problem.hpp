#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "prowl/model/configuration.hpp"
#include "prowl/motion/motion_problem.hpp"
#include "tests/support/robots.hpp"
#include "tests/support/zero_cost.hpp"

namespace prowl::test {

/// A robot on all its feet for two seconds, at rest at first, on a plane that falls by so many degrees towards -x and
/// turned with it. No cost.
inline MotionProblem standing_problem(RobotModel robot = hyq(), double degrees = 0.0, double friction = 0.5) {
  const double angle = degrees * std::numbers::pi / 180.0;
  MotionProblem problem{.name = "standing", .robot = std::move(robot)};
  Surface surface{.name = "slope", .friction = friction};
  surface.normal = {-std::sin(angle), 0.0, std::cos(angle)};
  problem.surfaces = {surface};
  Phase phase{.name = "stand", .duration = {2.0, 2.0}};
  for (int c = 0; c < static_cast<int>(problem.robot.contacts().size()); ++c) phase.contacts.push_back({c, 0});
  problem.phases = {phase};

  const Eigen::Matrix3d turn = Eigen::AngleAxisd(-angle, Eigen::Vector3d::UnitY()).toRotationMatrix();
  Eigen::VectorXd q = problem.robot.nominal_configuration();
  q.head<3>() = (turn * q.head<3>()).eval();
  set_base_rotation(q, turn * base_rotation(problem.robot.nominal_configuration()));
  BoundaryConstraint start = BoundaryConstraint::unbounded(problem.robot, "start", PhaseFraction::start_of(0), q);
  start.configuration_lower.setZero();
  start.configuration_upper.setZero();
  start.velocity_lower.setZero();
  start.velocity_upper.setZero();
  problem.boundary_constraints = {start};

  problem.running_cost = zero_cost(problem.robot);
  problem.running_cost.q_ref = q;
  problem.terminal_cost = problem.running_cost;
  return problem;
}

/// With a goal at its end: the base moved by so much from the start, world axes, its rotation as at the start.
inline MotionProblem with_base_goal(MotionProblem problem, const Eigen::Vector3d& displacement) {
  Eigen::VectorXd q = problem.start_configuration();
  q.head<3>() += displacement;
  const int last = static_cast<int>(problem.phases.size()) - 1;
  BoundaryConstraint goal = BoundaryConstraint::unbounded(problem.robot, "goal 1", PhaseFraction::end_of(last), q);
  goal.configuration_lower.head<6>().setZero();
  goal.configuration_upper.head<6>().setZero();
  problem.boundary_constraints.push_back(goal);
  return problem;
}

}  // namespace prowl::test
