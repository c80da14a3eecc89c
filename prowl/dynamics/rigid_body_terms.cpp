#include "prowl/dynamics/rigid_body_terms.hpp"

#include <algorithm>
#include <pinocchio/algorithm/frames.hpp>
#include <pinocchio/algorithm/jacobian.hpp>
#include <pinocchio/algorithm/rnea-derivatives.hpp>
#include <pinocchio/algorithm/rnea.hpp>
#include <pinocchio/multibody/data.hpp>

#include "prowl/model/pinocchio_model.hpp"

namespace prowl {

namespace {

/// Parents of the bodies, the base first: Pinocchio's joint 0 is the world.
std::vector<int> parents_of(const pinocchio::Model& model) {
  std::vector<int> parents;
  for (std::size_t joint = 1; joint < model.parents.size(); ++joint) {
    parents.push_back(static_cast<int>(model.parents[joint]) - 1);
  }
  return parents;
}

WorldInertia in_world(const pinocchio::Inertia& inertia) {
  const Eigen::Vector3d moment = inertia.mass() * inertia.lever();
  const Eigen::Matrix3d of_mass =
      moment.dot(inertia.lever()) * Eigen::Matrix3d::Identity() - moment * inertia.lever().transpose();
  return {inertia.mass(), moment, inertia.inertia().matrix() + of_mass};
}

}  // namespace

struct RigidBodyTerms::Workspace {
  explicit Workspace(const RobotModel& robot)
      : model(robot.pinocchio().model), data(model), hessian(parents_of(model)) {
    tree.bodies.resize(model.joints.size() - 1);
    pinocchio::computeJointJacobians(model, data, robot.nominal_configuration());
    joint_axes.resize(6, model.nv);
    for (pinocchio::JointIndex joint = 1; joint < model.joints.size(); ++joint) {
      for (int k = model.idx_vs[joint]; k < model.idx_vs[joint] + model.nvs[joint]; ++k) {
        joint_axes.col(k) = data.oMi[joint].actInv(pinocchio::Motion(data.J.col(k))).toVector();
      }
    }
  }

  void update_placements();
  void fetch_tree();

  pinocchio::Model model;
  pinocchio::Data data;
  SpatialColumns joint_axes;  ///< columns of data.J in the frame behind their joint, where they are constant
  TreeMotion tree;
  InverseDynamicsHessian hessian;
};

RigidBodyTerms::RigidBodyTerms(const RobotModel& robot)
    : nv_(robot.nv()),
      workspace_(std::make_unique<Workspace>(robot)),
      inverse_dynamics_(Eigen::VectorXd::Zero(nv_)),
      dq_(Eigen::MatrixXd::Zero(nv_, nv_)),
      dv_(Eigen::MatrixXd::Zero(nv_, nv_)),
      mass_matrix_(Eigen::MatrixXd::Zero(nv_, nv_)),
      motion_columns_(6, nv_) {
  const pinocchio::Model& model = workspace_->model;
  for (pinocchio::JointIndex body = kBaseJoint; body < model.joints.size(); ++body) {
    std::vector<int>& chain = chains_.emplace_back();
    for (pinocchio::JointIndex joint = body; joint > 0; joint = model.parents[joint]) {
      for (int i = model.nvs[joint] - 1; i >= 0; --i) chain.push_back(model.idx_vs[joint] + i);
    }
    std::reverse(chain.begin(), chain.end());
  }
  for (const pinocchio::FrameIndex index : robot.pinocchio().contact_frames) {
    const pinocchio::Frame& frame = model.frames[index];
    contacts_.push_back(
        {.body = static_cast<int>(frame.parentJoint - kBaseJoint), .in_body = frame.placement.translation()});
  }
}

RigidBodyTerms::~RigidBodyTerms() = default;
RigidBodyTerms::RigidBodyTerms(RigidBodyTerms&&) noexcept = default;

void RigidBodyTerms::update_kinematics(const Eigen::VectorXd& q) {
  pinocchio::computeJointJacobians(workspace_->model, workspace_->data, q);
  fetch_kinematics();
}

void RigidBodyTerms::update(const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& a) {
  inverse_dynamics_ = pinocchio::rnea(workspace_->model, workspace_->data, q, v, a);
  workspace_->update_placements();
  fetch_kinematics();
}

// Like computeJointJacobians, from the placements of rnea, without computing sines and cosines again.
void RigidBodyTerms::Workspace::update_placements() {
  for (pinocchio::JointIndex joint = 1; joint < model.joints.size(); ++joint) {
    const pinocchio::JointIndex parent = model.parents[joint];
    data.oMi[joint] = parent > 0 ? data.oMi[parent] * data.liMi[joint] : data.liMi[joint];
    const Eigen::Matrix3d& R = data.oMi[joint].rotation();
    const Eigen::Vector3d& p = data.oMi[joint].translation();
    for (int k = model.idx_vs[joint]; k < model.idx_vs[joint] + model.nvs[joint]; ++k) {
      const Eigen::Vector3d linear = R * joint_axes.col(k).head<3>(), angular = R * joint_axes.col(k).tail<3>();
      data.J.col(k) << linear + p.cross(angular), angular;
    }
  }
}

void RigidBodyTerms::update_with_derivatives(const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                                             const Eigen::VectorXd& a) {
  auto& model = workspace_->model;
  auto& data = workspace_->data;
  // It writes only the entries that the tree makes non-zero; the others stay as the constructor set them.
  pinocchio::computeRNEADerivatives(model, data, q, v, a, dq_, dv_, mass_matrix_);
  mass_matrix_.triangularView<Eigen::StrictlyLower>() = mass_matrix_.transpose();
  // Inverse dynamics do not depend on the base position. (Pinocchio leaves rounding there.)
  dq_.leftCols<3>().setZero();
  inverse_dynamics_ = data.tau;
  fetch_kinematics();
}

void RigidBodyTerms::fetch_kinematics() { motion_columns_ = workspace_->data.J; }

Eigen::Vector3d RigidBodyTerms::contact_position(int contact) const {
  const BodyPoint& point = contact_point(contact);
  return body_position(point.body) + body_rotation(point.body) * point.in_body;
}

Eigen::Ref<const Eigen::Matrix3d> RigidBodyTerms::body_rotation(int body) const {
  return workspace_->data.oMi[kBaseJoint + static_cast<std::size_t>(body)].rotation();
}

Eigen::Ref<const Eigen::Vector3d> RigidBodyTerms::body_position(int body) const {
  return workspace_->data.oMi[kBaseJoint + static_cast<std::size_t>(body)].translation();
}

// By-products of computeRNEADerivatives: oinertias of the bodies; oYcrb, doYcrb of the composites; one column per
// degree of freedom; dAdq without gravity, which it removes at its end.
void RigidBodyTerms::Workspace::fetch_tree() {
  for (std::size_t i = 0; i < tree.bodies.size(); ++i) {
    TreeMotion::Body& body = tree.bodies[i];
    body.velocity = data.ov[i + 1].toVector();
    body.inertia = in_world(data.oinertias[i + 1]);
    body.composite_inertia = in_world(data.oYcrb[i + 1]);
    body.composite_variation = data.doYcrb[i + 1].rightCols<3>();
  }
  tree.S = data.J;
  tree.V = data.dVdq;
  tree.A = data.dAdq;
  for (Eigen::Index k = 0; k < tree.A.cols(); ++k) {
    tree.A.col(k).head<3>() -= model.gravity.linear().cross(tree.S.col(k).tail<3>());
  }
  tree.W = data.dAdv;
  tree.I_S = data.dFda;
  tree.I_W_B_S = data.dFdv;
  tree.I_A_B_V_S_F = data.dFdq;
}

void RigidBodyTerms::add_second_derivatives(const Eigen::VectorXd& lambda, SecondDerivatives& result) {
  workspace_->fetch_tree();
  workspace_->hessian.add(workspace_->tree, lambda, result);
}

}  // namespace prowl
