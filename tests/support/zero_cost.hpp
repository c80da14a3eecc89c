#pragma once

#include "prowl/model/robot_model.hpp"
#include "prowl/motion/cost.hpp"

namespace prowl::test {

/// About the nominal posture, all weights 0.
inline QuadraticCost zero_cost(const RobotModel& robot) {
  QuadraticCost cost;
  cost.q_ref = robot.nominal_configuration();
  cost.configuration_weight = cost.velocity_weight = cost.acceleration_weight = Eigen::VectorXd::Zero(robot.nv());
  cost.tau_ref = cost.torque_weight = Eigen::VectorXd::Zero(robot.nu());
  return cost;
}

}  // namespace prowl::test
