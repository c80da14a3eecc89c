#include "prowl/tracking/rest_torque.hpp"

#include <fmt/format.h>

#include <Eigen/QR>

#include "prowl/dynamics/forward_dynamics.hpp"
#include "prowl/error.hpp"

namespace prowl {

Eigen::VectorXd rest_torque(const RobotModel& robot, const std::vector<int>& contacts, const Eigen::VectorXd& q,
                            const Eigen::VectorXd& tau) {
  ForwardDynamics dynamics(robot, contacts);
  const Eigen::VectorXd still = Eigen::VectorXd::Zero(robot.nv());
  dynamics.evaluate_with_derivatives(q, still, tau);
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> effect;
  effect.setThreshold(1e-9);
  effect.compute(dynamics.acceleration_derivatives().tau);
  const Eigen::VectorXd rest = tau - effect.solve(dynamics.acceleration());
  dynamics.evaluate(q, still, rest);  // linear in the torques: what is left no torque takes away
  constexpr double kSlowest = 1e-3;   // [m/s^2]
  if (dynamics.acceleration().norm() > kSlowest) {
    throw NumericalError(fmt::format("no torques hold {} where its motion ends: it is not a posture to rest in", robot.name()));
  }
  return rest;
}

}  // namespace prowl
