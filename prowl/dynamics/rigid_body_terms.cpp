#include "prowl/dynamics/rigid_body_terms.hpp"

#include <algorithm>
#include <pinocchio/algorithm/frames.hpp>
#include <pinocchio/algorithm/jacobian.hpp>
#include <pinocchio/algorithm/rnea-derivatives.hpp>
#include <pinocchio/algorithm/rnea-second-order-derivatives.hpp>
#include <pinocchio/algorithm/rnea.hpp>
#include <pinocchio/multibody/data.hpp>

#include "prowl/model/pinocchio_model.hpp"

namespace prowl {

SecondDerivatives::SecondDerivatives(int nv) : qq(nv, nv), qv(nv, nv), vv(nv, nv), qa(nv, nv) { set_zero(); }

void SecondDerivatives::set_zero() {
  qq.setZero();
  qv.setZero();
  vv.setZero();
  qa.setZero();
}

struct RigidBodyTerms::Workspace {
  explicit Workspace(const RobotModel& robot)
      : model(robot.pinocchio().model), contact_frames(robot.pinocchio().contact_frames), data(model) {}

  pinocchio::Model model;
  std::vector<pinocchio::FrameIndex> contact_frames;
  pinocchio::Data data;
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
  for (const pinocchio::FrameIndex frame : workspace_->contact_frames) {
    std::vector<int> chain;
    for (pinocchio::JointIndex joint = model.frames[frame].parentJoint; joint > 0; joint = model.parents[joint]) {
      for (int i = model.nvs[joint] - 1; i >= 0; --i) chain.push_back(model.idx_vs[joint] + i);
    }
    std::reverse(chain.begin(), chain.end());
    chains_.push_back(std::move(chain));
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
  update_kinematics(q);
}

void RigidBodyTerms::update_with_derivatives(const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                                             const Eigen::VectorXd& a) {
  auto& [model, frames, data] = *workspace_;
  dq_.setZero();  // Pinocchio writes only the entries that the tree makes non-zero
  dv_.setZero();
  mass_matrix_.setZero();
  pinocchio::computeRNEADerivatives(model, data, q, v, a, dq_, dv_, mass_matrix_);
  mass_matrix_.triangularView<Eigen::StrictlyLower>() = mass_matrix_.transpose();
  // Inverse dynamics does not depend on where the base is. (Pinocchio leaves rounding there.)
  dq_.leftCols<3>().setZero();
  inverse_dynamics_ = data.tau;
  fetch_kinematics();
}

void RigidBodyTerms::fetch_kinematics() {
  auto& [model, frames, data] = *workspace_;
  motion_columns_ = data.J;
  for (const pinocchio::FrameIndex frame : frames) {
    data.oMf[frame] = data.oMi[model.frames[frame].parentJoint] * model.frames[frame].placement;
  }
}

Eigen::Vector3d RigidBodyTerms::contact_position(int contact) const {
  return workspace_->data.oMf[workspace_->contact_frames[static_cast<size_t>(contact)]].translation();
}

void RigidBodyTerms::add_second_derivatives(const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                                            const Eigen::VectorXd& a, const Eigen::VectorXd& lambda,
                                            SecondDerivatives& result) {
  auto& [model, frames, data] = *workspace_;
  pinocchio::ComputeRNEASecondOrderDerivatives(model, data, q, v, a);

  // Tensors are (row of r0, first index, second index), row fastest: one product contracts the rows.
  const auto contract = [&](const auto& tensor) -> Eigen::MatrixXd {
    const Eigen::Map<const Eigen::MatrixXd> flat(tensor.data(), nv_, nv_ * nv_);
    const Eigen::RowVectorXd contracted = lambda.transpose() * flat;
    return Eigen::Map<const Eigen::MatrixXd>(contracted.data(), nv_, nv_);
  };
  Eigen::MatrixXd qq = contract(data.d2tau_dqdq);
  Eigen::MatrixXd qv = contract(data.d2tau_dqdv);
  const Eigen::MatrixXd vv = contract(data.d2tau_dvdv);
  Eigen::MatrixXd qa = contract(data.d2tau_dadq).transpose();

  // No dependence on the place of the base; and rotations do not commute: the Hessian along q (+) d is the
  // symmetric part of the second directional derivatives.
  qq.topRows<3>().setZero();
  qq.leftCols<3>().setZero();
  qv.topRows<3>().setZero();
  qa.topRows<3>().setZero();
  result.qq += 0.5 * (qq + qq.transpose());
  result.qv += qv;
  result.vv += 0.5 * (vv + vv.transpose());
  result.qa += qa;
}

}  // namespace prowl
