#pragma once

#include "prowl/dynamics/static_equilibrium.hpp"
#include "prowl/tracker/tracker.hpp"
#include "tests/support/standing_problem.hpp"

namespace prowl::test {

/// Holds the start of standing_problem() with static torques and a spring and a damper at each joint.
inline Tracker standing_tracker(const MotionProblem& problem, double stiffness = 800.0, double damping = 20.0) {
  const RobotModel& robot = problem.robot;
  TrackingPlan plan;
  for (const ContactPoint& contact : robot.contacts()) plan.contact_names.push_back(contact.name);
  plan.joint_names = robot.joint_names();
  plan.torque_limit = robot.torque_limit();
  plan.segments = {
      {"stand", 0.0, problem.phases.front().duration.min, 0, 2, std::vector<bool>(robot.contacts().size(), true)}};
  const Eigen::VectorXd& q = problem.start_configuration();
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(robot.nu(), 2 * robot.nv());
  K.block(0, 6, robot.nu(), robot.nu()).diagonal().setConstant(stiffness);
  K.rightCols(robot.nu()).diagonal().setConstant(damping);
  plan.q = q.replicate(1, 2);
  plan.v = Eigen::MatrixXd::Zero(robot.nv(), 2);
  plan.tau = static_equilibrium(robot, q, contact_indices(problem.phases.front().contacts)).tau.replicate(1, 2);
  plan.gains = K.reshaped().replicate(1, 2);
  return Tracker(plan);
}

}  // namespace prowl::test
