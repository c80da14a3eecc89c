#include "prowl/model/body_tree.hpp"

#include "prowl/model/pinocchio_model.hpp"

namespace prowl {
namespace {}  // namespace

BodyTree body_tree(const RobotModel& robot) {
  const PinocchioModel& pin = robot.pinocchio();
  const pinocchio::Model& model = pin.model;
  BodyTree tree;
  for (pinocchio::JointIndex j = kBaseJoint; j < model.joints.size(); ++j) {
    RigidBody& body = tree.bodies.emplace_back();
    body.name = j == kBaseJoint ? "base" : model.names[j];
    body.parent = static_cast<int>(model.parents[j]) - static_cast<int>(kBaseJoint);
    const pinocchio::SE3& placement = model.jointPlacements[j];
    body.placement.linear() = placement.rotation();
    body.placement.translation() = placement.translation();
    body.mass = model.inertias[j].mass();
    body.center = model.inertias[j].lever();
    body.inertia = model.inertias[j].inertia().matrix();
    if (j == kBaseJoint) continue;
    pinocchio::JointData data = model.joints[j].createData();
    model.joints[j].calc(data, Eigen::VectorXd(Eigen::VectorXd::Zero(model.nq)));
    const Eigen::Matrix<double, 6, 1> twist = data.S().matrix();  // linear, angular
    body.prismatic = robot.joint_is_prismatic()[j - kBaseJoint - 1];
    body.axis = body.prismatic ? twist.head<3>() : twist.tail<3>();
  }
  for (const pinocchio::FrameIndex index : pin.contact_frames) {
    const pinocchio::Frame& frame = model.frames[index];
    tree.points.push_back({static_cast<int>(frame.parentJoint - kBaseJoint), frame.placement.translation()});
  }
  return tree;
}

}  // namespace prowl
