#include "prowl/trajectory/state_scale.hpp"

#include <array>

#include "prowl/model/configuration.hpp"

namespace prowl {

Eigen::VectorXd state_scale(const Trajectory& trajectory) {
  const TrajectoryPoint& first = trajectory.nodes.front();
  const Eigen::Index nv = first.v.size();
  Eigen::VectorXd largest = Eigen::VectorXd::Zero(2 * nv);
  for (const TrajectoryPoint& node : trajectory.nodes) {
    largest.head(nv) = largest.head(nv).cwiseMax(difference(first.q, node.q).cwiseAbs());
    largest.tail(nv) = largest.tail(nv).cwiseMax(node.v.cwiseAbs());
  }
  return largest.array() + 1.0;
}

Eigen::VectorXd scaled_difference(const Eigen::VectorXd& q0, const Eigen::VectorXd& v0, const Eigen::VectorXd& q1,
                                  const Eigen::VectorXd& v1, const Eigen::VectorXd& scale) {
  Eigen::VectorXd delta(scale.size());
  delta << difference(q0, q1), v1 - v0;
  return delta.cwiseQuotient(scale);
}

std::string coordinate_name(const RobotModel& robot, Eigen::Index i) {
  static constexpr std::array kBase = {"base x",          "base y",          "base z",
                                       "base rotation x", "base rotation y", "base rotation z"};
  return i < 6 ? kBase[i] : robot.joint_names()[i - 6];
}

std::string state_name(const RobotModel& robot, Eigen::Index i) {
  return i < robot.nv() ? coordinate_name(robot, i) : "velocity of " + coordinate_name(robot, i - robot.nv());
}

}  // namespace prowl
