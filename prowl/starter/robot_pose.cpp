#include "prowl/starter/robot_pose.hpp"

#include <algorithm>
#include <cmath>

#include "prowl/model/configuration.hpp"

namespace prowl {

RobotPose::RobotPose(const RobotModel& robot, const Eigen::Matrix3d& upright)
    : robot_(robot),
      tree_(body_tree(robot)),
      links_(link_tree(robot)),
      placements_(robot),
      q_(Eigen::VectorXd::Zero(robot.nq())) {
  set_base_rotation(q_, upright);
  set(Eigen::VectorXd::Zero(robot.nu()));
}

void RobotPose::set(const Eigen::VectorXd& joints) {
  q_.tail(joints.size()) = joints;
  bodies_ = &placements_.at(q_);
}

Eigen::Vector3d RobotPose::contact(std::size_t index) const {
  return point(tree_.points[index].body, tree_.points[index].position);
}

Eigen::Vector3d RobotPose::center_of_mass() const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t b = 0; b < tree_.bodies.size(); ++b) {
    sum += tree_.bodies[b].mass * point(static_cast<int>(b), tree_.bodies[b].center);
  }
  return sum / robot_.mass();
}

Eigen::VectorXd neutral_joints(const RobotModel& robot) {
  constexpr double kMargin = 0.1;       // [rad]
  constexpr double kMarginShare = 0.1;  // of the range
  Eigen::VectorXd joints = Eigen::VectorXd::Zero(robot.nu());
  for (Eigen::Index j = 0; j < joints.size(); ++j) {
    const double lower = robot.position_lower()(j), upper = robot.position_upper()(j);
    const double margin = std::min(kMargin, kMarginShare * (upper - lower));
    joints(j) = std::max(lower + margin, std::min(0.0, upper - margin));
  }
  return joints;
}

}  // namespace prowl
