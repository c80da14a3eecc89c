#include "tests/support/null_space_dynamics.hpp"

#include <Eigen/Cholesky>
#include <Eigen/SVD>
#include <pinocchio/algorithm/crba.hpp>
#include <pinocchio/algorithm/frames.hpp>
#include <pinocchio/algorithm/jacobian.hpp>
#include <pinocchio/algorithm/kinematics.hpp>
#include <pinocchio/algorithm/rnea.hpp>
#include <pinocchio/multibody/data.hpp>

#include "prowl/model/pinocchio_model.hpp"

namespace prowl::test {

struct NullSpaceDynamics::Workspace {
  const pinocchio::Model& model;
  pinocchio::Data data;
  std::vector<pinocchio::FrameIndex> frames;
  Eigen::VectorXd q;
};

NullSpaceDynamics::NullSpaceDynamics(const RobotModel& robot, std::vector<int> contacts) {
  const PinocchioModel& pin = robot.pinocchio();
  std::vector<pinocchio::FrameIndex> frames;
  for (const int contact : contacts) frames.push_back(pin.contact_frames[contact]);
  workspace_.reset(new Workspace{pin.model, pinocchio::Data(pin.model), std::move(frames), {}});
}

NullSpaceDynamics::~NullSpaceDynamics() = default;

void NullSpaceDynamics::set_configuration(const Eigen::VectorXd& q) {
  auto& [model, data, frames, last_q] = *workspace_;
  last_q = q;
  pinocchio::computeJointJacobians(model, data, q);
  pinocchio::updateFramePlacements(model, data);
  J.resize(3 * static_cast<Eigen::Index>(frames.size()), model.nv);
  for (std::size_t c = 0; c < frames.size(); ++c) {
    Eigen::MatrixXd frame_jacobian = Eigen::MatrixXd::Zero(6, model.nv);
    pinocchio::getFrameJacobian(model, data, frames[c], pinocchio::LOCAL_WORLD_ALIGNED, frame_jacobian);
    J.middleRows<3>(static_cast<Eigen::Index>(3 * c)) = frame_jacobian.topRows<3>();
  }

  rank = 0;
  N = Eigen::MatrixXd::Identity(model.nv, model.nv);
  pseudo_inverse = Eigen::MatrixXd::Zero(model.nv, J.rows());
  if (J.rows() == 0) return;
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(J, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::VectorXd& sigma = svd.singularValues();
  while (rank < sigma.size() && sigma(rank) > 1e-8 * sigma(0)) ++rank;
  J_norm = sigma(0);
  singular_value_ratio = sigma(rank - 1) / sigma(0);
  N = svd.matrixV().rightCols(model.nv - rank);
  pseudo_inverse = svd.matrixV().leftCols(rank) * sigma.head(rank).cwiseInverse().asDiagonal() *
                   svd.matrixU().leftCols(rank).transpose();
}

Eigen::VectorXd NullSpaceDynamics::solve(const Eigen::VectorXd& v, const Eigen::VectorXd& tau) {
  auto& [model, data, frames, q] = *workspace_;
  pinocchio::crba(model, data, Eigen::Ref<const Eigen::VectorXd>(q));
  M = data.M.selfadjointView<Eigen::Upper>();
  applied = -pinocchio::nonLinearEffects(model, data, q, v);
  applied.tail(tau.size()) += tau;
  pinocchio::forwardKinematics(model, data, q, v, Eigen::VectorXd::Zero(model.nv));
  J_dot_v.resize(J.rows());
  for (std::size_t c = 0; c < frames.size(); ++c) {
    J_dot_v.segment<3>(static_cast<Eigen::Index>(3 * c)) =
        pinocchio::getFrameClassicalAcceleration(model, data, frames[c], pinocchio::LOCAL_WORLD_ALIGNED).linear();
  }
  const Eigen::VectorXd a_contact = -pseudo_inverse * J_dot_v;
  const Eigen::MatrixXd reduced_mass = N.transpose() * M * N;
  return a_contact + N * reduced_mass.llt().solve(N.transpose() * (applied - M * a_contact));
}

}  // namespace prowl::test
