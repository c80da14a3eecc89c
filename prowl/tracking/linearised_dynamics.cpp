#include "prowl/tracking/linearised_dynamics.hpp"

#include <Eigen/Cholesky>
#include <Eigen/QR>

#include "prowl/linear_algebra/factorisations.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/model/so3.hpp"

namespace prowl {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// M⁻¹ V (V' M⁻¹ V)⁻¹: maps y to the velocity change by impulses along V that changes V' v by y.
MatrixXd impulse_response(const MatrixXd& M, const MatrixXd& V) {
  const MatrixXd moved = M.llt().solve(V);
  return (V.transpose() * moved).llt().solve(moved.transpose()).transpose();
}

}  // namespace

LinearisedDynamics::LinearisedDynamics(const RobotModel& robot, std::vector<int> contacts)
    : dynamics_(robot, contacts, kContactRankThreshold), terms_(robot), kinematics_(std::move(contacts)) {}

void LinearisedDynamics::evaluate(const VectorXd& q, const VectorXd& v, const VectorXd& tau) {
  q_ = q;
  v_ = v;
  const Eigen::Index nv = v.size();
  dynamics_.evaluate_with_derivatives(q, v, tau);
  const ForwardDynamics::Derivatives& da = dynamics_.acceleration_derivatives();

  // Rates of dq: p' = R v_p with R = R* exp(phi), and phi' = w - w* - w* x phi to first order; docs/tracking.md.
  const Eigen::Matrix3d R = base_rotation(q);
  A_.setZero(2 * nv, 2 * nv);
  A_.block<3, 3>(0, 3) = -R * so3::skew(v.head<3>());
  A_.block<3, 3>(3, 3) = -so3::skew(v.segment<3>(3));
  A_.block(0, nv, nv, nv).setIdentity();
  A_.block<3, 3>(0, nv) = R;
  A_.bottomRows(nv) << da.q, da.v;
  B_.setZero(2 * nv, tau.size());
  B_.bottomRows(nv) = da.tau;

  // J⁺ = V T⁻¹ U' (projector.hpp): V' J⁺ maps the rows of all contacts to rank J independent ones,
  // even if there are more. V' J⁺ J = V'.
  terms_.update_kinematics(q);
  kinematics_.set_configuration(terms_);
  kinematics_.set_motion(VectorXd::Zero(nv), v);  // the acceleration is then J v
  kinematics_.acceleration_dq(turned_velocity_);
  const MatrixXd V = dynamics_.projector().row_space();
  const MatrixXd rows = V.transpose() * dynamics_.projector().pseudo_inverse();
  C_.setZero(2 * V.cols(), 2 * nv);
  C_.topLeftCorner(V.cols(), nv) = rows * kinematics_.positions_dq();
  C_.bottomLeftCorner(V.cols(), nv) = rows * turned_velocity_;
  C_.bottomRightCorner(V.cols(), nv) = V.transpose();
}

MatrixXd LinearisedDynamics::consistent_directions(const VectorXd& weight) const {
  const VectorXd scale = weight.cwiseSqrt().cwiseInverse();
  const Eigen::Index size = weight.size(), fixed = C_.rows();
  MatrixXd basis = MatrixXd::Identity(size, size).rightCols(size - fixed);
  if (fixed > 0) {
    const MatrixXd normals = (C_ * scale.asDiagonal()).transpose();
    basis.applyOnTheLeft(Eigen::HouseholderQR<MatrixXd>(normals).householderQ());
  }
  return scale.asDiagonal() * basis;
}

VectorXd LinearisedDynamics::with_stance_legs(VectorXd weight, double share) const {
  const Eigen::Index nv = v_.size();
  if (kinematics_.rows() == 0) return weight;
  for (Eigen::Index j = 6; j < nv; ++j) {
    if (kinematics_.jacobian().col(j).isZero(0.0)) continue;
    weight(j) *= share;
    weight(nv + j) *= share;
  }
  return weight;
}

MatrixXd LinearisedDynamics::impedance(const VectorXd& rates) {
  const Eigen::Index nv = v_.size(), nu = nv - 6, rows = kinematics_.rows();
  if (rates.isZero(0.0)) return MatrixXd::Zero(nu, 2 * nv);
  terms_.update_with_derivatives(q_, v_, VectorXd::Zero(nv));
  MatrixXd wanted(rows, 2 * nv);  // accelerations, without their sign
  for (Eigen::Index row = 0; row < rows; ++row) {
    const double rate = rates(row / 3);
    wanted.row(row) << 0.25 * rate * rate * kinematics_.positions_dq().row(row) + rate * turned_velocity_.row(row),
        rate * kinematics_.jacobian().row(row);
  }
  return terms_.mass_matrix().bottomRightCorner(nu, nu) * damped_solution(kinematics_.jacobian().rightCols(nu), wanted);
}

MatrixXd LinearisedDynamics::landing(const VectorXd& weight) {
  const Eigen::Index nv = v_.size(), rank = C_.rows() / 2;
  MatrixXd result = MatrixXd::Identity(2 * nv, 2 * nv);
  if (rank == 0) return result;

  const VectorXd inverse_weight = weight.head(nv).cwiseInverse();
  const MatrixXd positions = C_.topLeftCorner(rank, nv);
  const MatrixXd spread = inverse_weight.asDiagonal() * positions.transpose();
  const MatrixXd kept = MatrixXd::Identity(nv, nv) - spread * (positions * spread).ldlt().solve(positions);  // of dq
  result.topLeftCorner(nv, nv) = kept;

  terms_.update_with_derivatives(q_, v_, VectorXd::Zero(nv));
  const MatrixXd V = C_.bottomRightCorner(rank, nv).transpose();
  const MatrixXd response = impulse_response(terms_.mass_matrix(), V);
  result.bottomLeftCorner(nv, nv) = -response * C_.bottomLeftCorner(rank, nv) * kept;
  result.bottomRightCorner(nv, nv) -= response * V.transpose();
  return result;
}

VectorXd velocity_after_landing(const RobotModel& robot, const std::vector<int>& contacts, const VectorXd& q,
                                const VectorXd& v) {
  RigidBodyTerms terms(robot);
  terms.update_with_derivatives(q, v, VectorXd::Zero(v.size()));
  ContactKinematics kinematics(contacts);
  kinematics.set_configuration(terms);
  Projector projector;
  projector.compute(kinematics.jacobian(), kContactRankThreshold);
  if (projector.rank() == 0) return v;
  const MatrixXd V = projector.row_space();
  return v - impulse_response(terms.mass_matrix(), V) * (V.transpose() * v);
}

}  // namespace prowl
