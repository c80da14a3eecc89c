#include "prowl/dynamics/body_bounds.hpp"

#include <algorithm>
#include <cmath>

#include "prowl/dynamics/centroidal_kinematics.hpp"
#include "prowl/model/body_tree.hpp"
#include "prowl/model/pinocchio_model.hpp"

namespace prowl {

namespace {

/// Root of the chain from the base to a joint, and its length up to that joint's origin.
struct Chain {
  Eigen::Vector3d root = Eigen::Vector3d::Zero();
  double length = 0.0;
  int first_joint = -1;
};

bool is_prismatic(const RobotModel& robot, int joint) {
  return robot.joint_is_prismatic()[static_cast<std::size_t>(joint)];
}

/// How far a joint moves what it carries from its origin: 0 if it turns [m].
double largest_travel(const RobotModel& robot, int joint) {
  if (!is_prismatic(robot, joint)) return 0.0;
  return std::max(std::abs(robot.position_lower()(joint)), std::abs(robot.position_upper()(joint)));
}

Chain chain_to(const RobotModel& robot, pinocchio::JointIndex joint) {
  const pinocchio::Model& model = robot.pinocchio().model;
  Chain chain;
  for (; joint != kBaseJoint; joint = model.parents[joint]) {
    const Eigen::Vector3d& step = model.jointPlacements[joint].translation();
    chain.first_joint = model.idx_vs[joint] - 6;
    chain.length += largest_travel(robot, chain.first_joint);
    if (model.parents[joint] == kBaseJoint) {
      chain.root = step;
    } else {
      chain.length += step.norm();
    }
  }
  return chain;
}

}  // namespace

ContactReach contact_reach(const RobotModel& robot, int contact) {
  const PinocchioModel& pin = robot.pinocchio();
  const pinocchio::Frame& frame = pin.model.frames[pin.contact_frames[contact]];
  const Eigen::Vector3d& tip = frame.placement.translation();
  if (frame.parentJoint == kBaseJoint) return {tip, 0.0, -1};
  const Chain chain = chain_to(robot, frame.parentJoint);
  return {chain.root, chain.length + tip.norm(), chain.first_joint};
}

double largest_distance(const RobotModel& robot, const BodyPoint& a, const BodyPoint& b) {
  const std::vector<RigidBody> bodies = body_tree(robot).bodies;
  BodyPoint one = a, other = b;
  double length = 0.0;
  while (one.body != other.body) {  // parents come first, so the later body is not before the other
    BodyPoint& later = one.body > other.body ? one : other;
    length += later.in_body.norm() + largest_travel(robot, later.body - 1);
    later.in_body = bodies[later.body].placement.translation();
    later.body = bodies[later.body].parent;
  }
  return length + (one.in_body - other.in_body).norm();
}

std::vector<JointLever> joint_levers(const RobotModel& robot, int contact) {
  const PinocchioModel& pin = robot.pinocchio();
  const pinocchio::Frame& frame = pin.model.frames[pin.contact_frames[contact]];
  std::vector<JointLever> levers;
  double length = frame.placement.translation().norm();  // from the joint's origin to the point
  for (pinocchio::JointIndex joint = frame.parentJoint; joint != kBaseJoint; joint = pin.model.parents[joint]) {
    const int own = pin.model.idx_vs[joint] - 6;
    levers.push_back({own, is_prismatic(robot, own) ? 1.0 : length});
    length += largest_travel(robot, own) + pin.model.jointPlacements[joint].translation().norm();
  }
  std::ranges::reverse(levers);
  return levers;
}

MassMotion centre_of_mass(const RobotModel& robot, const Eigen::VectorXd& q, const Eigen::VectorXd& v) {
  CentroidalKinematics kinematics(robot);
  kinematics.update(q, v);
  return {kinematics.com(), kinematics.momentum().head<3>() / robot.mass()};
}

MassReach mass_reach(const RobotModel& robot) {
  const pinocchio::Model& model = robot.pinocchio().model;
  MassReach result{model.inertias[kBaseJoint].mass() * model.inertias[kBaseJoint].lever()};
  for (pinocchio::JointIndex joint = kBaseJoint + 1; joint < model.joints.size(); ++joint) {
    const Chain chain = chain_to(robot, joint);
    result.centre += model.inertias[joint].mass() * chain.root;
    result.radius += model.inertias[joint].mass() * (chain.length + model.inertias[joint].lever().norm());
  }
  result.centre /= robot.mass();
  result.radius /= robot.mass();
  return result;
}

}  // namespace prowl
