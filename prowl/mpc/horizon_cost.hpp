#pragma once

#include <Eigen/Core>

#include "prowl/model/robot_model.hpp"
#include "prowl/motion/cost.hpp"
#include "prowl/mpc/mpc_weights.hpp"

namespace prowl {

/// Running cost of a horizon, per second; configurations from `q_ref` (nq), which steps replace by their own.
QuadraticCost horizon_cost(const RobotModel& robot, const MpcWeights& weights, const Eigen::VectorXd& q_ref);
/// Cost of the state at its end.
QuadraticCost horizon_end_cost(const RobotModel& robot, const MpcWeights& weights, const Eigen::VectorXd& q_ref);

}  // namespace prowl
