#include "prowl/mpc/horizon_cost.hpp"

#include <cmath>

namespace prowl {
namespace {

using Eigen::VectorXd;

/// Cost of the state, and of inputs, in physical units.
QuadraticCost quadratic(const RobotModel& robot, const MpcWeights& w, const VectorXd& q_ref) {
  const int nv = robot.nv(), nu = robot.nu();
  const double l = robot.size(), time = std::sqrt(l / RobotModel::kGravity), force = robot.weight();
  QuadraticCost cost;
  cost.q_ref = q_ref;
  cost.v_ref = VectorXd::Zero(nv);
  cost.configuration_weight.resize(nv);
  cost.velocity_weight.resize(nv);
  cost.acceleration_weight.resize(nv);
  cost.configuration_weight.head<6>() << Eigen::Vector3d(w.place, w.place, w.height) / (l * l), w.tilt, w.tilt,
      w.heading;
  cost.velocity_weight.head<6>() << Eigen::Vector3d(w.velocity, w.velocity, w.climb) * (time * time / (l * l)),
      Eigen::Vector3d::Constant(w.turning * time * time);
  const double g = RobotModel::kGravity;
  cost.acceleration_weight.head<6>() << Eigen::Vector3d::Constant(w.acceleration / (g * g)),
      Eigen::Vector3d::Constant(w.acceleration * time * time * time * time);
  cost.configuration_weight.tail(nu).setConstant(w.posture);
  cost.velocity_weight.tail(nu).setConstant(w.joint_rate * time * time);
  cost.acceleration_weight.tail(nu).setConstant(w.acceleration * time * time * time * time);
  cost.tau_ref = VectorXd::Zero(nu);
  cost.torque_weight = VectorXd::Constant(nu, w.torque / (force * l * force * l));
  cost.force_weight.setConstant(w.force / (force * force));
  return cost;
}

}  // namespace

QuadraticCost horizon_cost(const RobotModel& robot, const MpcWeights& weights, const VectorXd& q_ref) {
  QuadraticCost cost = quadratic(robot, weights, q_ref);
  const double rate = 1.0 / std::sqrt(robot.size() / RobotModel::kGravity);
  for (VectorXd* weight :
       {&cost.configuration_weight, &cost.velocity_weight, &cost.acceleration_weight, &cost.torque_weight})
    *weight *= rate;
  cost.force_weight *= rate;
  return cost;
}

QuadraticCost horizon_end_cost(const RobotModel& robot, const MpcWeights& weights, const VectorXd& q_ref) {
  QuadraticCost cost = quadratic(robot, weights, q_ref);
  cost.configuration_weight *= weights.terminal;
  cost.velocity_weight *= weights.terminal;
  for (VectorXd* weight : {&cost.acceleration_weight, &cost.torque_weight}) weight->setZero();
  cost.force_weight.setZero();
  return cost;
}

}  // namespace prowl
