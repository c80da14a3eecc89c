#include "alternatives/centroidal/centroidal_node.hpp"
#include "prowl/model/so3.hpp"

namespace prowl {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

void CentroidalNode::add_derivatives(const CentroidalPoint& point, CentroidalValues& values) {
  const CentroidalColumns& at = columns(point.node);
  const Matrix3d Jr = so3::right_jacobian(point.x.segment<3>(3));
  rotation_.setZero(num_rows(point.node), 3);
  values.jacobian.entries.clear();
  if (at.ends_interval()) add_dynamics(point, values.jacobian);
  add_kinematics(point, Jr, values.jacobian);
  add_limits(point, Jr, values.jacobian);

  cost_.derivatives(cost_point_, forces_, cost_slope_);
  VectorXd& gradient = values.cost_gradient;
  gradient.setZero(at.size + 1);
  gradient.head(nv_) = cost_slope_.gradient.head(nv_);
  gradient.segment(at.v, nv_) = cost_slope_.gradient.segment(nv_, nv_);
  if (at.ends_interval()) {
    gradient.segment<3>(at.com_acceleration) = cost_slope_.gradient.segment<3>(2 * nv_);
    gradient.segment(at.forces, forces_.size()) = cost_slope_.force_gradient;
    gradient(at.size) = cost_.running() / point.duration;  // the running cost is proportional to the duration
  }
  rotation_gradient_ = gradient.segment<3>(3);
  gradient.segment<3>(3) = Jr.transpose() * rotation_gradient_;
}

void CentroidalNode::add_q(int row, const Eigen::Ref<const MatrixXd>& dq, const Matrix3d& Jr, double scale,
                           SparseEntries& jacobian) {
  const MatrixXd turning = scale * dq.middleCols<3>(3);
  rotation_.middleRows(row, dq.rows()) = turning;
  jacobian.block(row, 3, (turning * Jr).eval());
}

void CentroidalNode::add_dynamics(const CentroidalPoint& point, SparseEntries& jacobian) const {
  const int k = point.node;
  const CentroidalColumns& at = columns(k);
  const Vector3d r = point.x.segment<3>(at.com);
  const int force_row = first_row(k, newton), moment_row = first_row(k, moment);
  const double per_moment = 1.0 / (scale_.force * scale_.length);
  jacobian.diagonal(force_row, at.com_acceleration, 3, mass_ / scale_.force);
  jacobian.diagonal(moment_row, at.momentum_rate, 3, per_moment);
  Vector3d total = Vector3d::Zero();
  int cone = first_row(k, friction), no_force = first_row(k, unloaded);
  for (int i = 0; i < num_contacts(); ++i) {
    const Vector3d f = forces_.segment<3>(3 * i), arm = point.x.segment<3>(at.contacts + 3 * i) - r;
    const int column = at.forces + 3 * i;
    total += f;
    jacobian.diagonal(force_row, column, 3, -1.0 / scale_.force);
    jacobian.block(moment_row, at.contacts + 3 * i, (per_moment * so3::skew(f)).eval());
    jacobian.block(moment_row, column, (-per_moment * so3::skew(arm)).eval());
    if (unloads(k, i)) {
      jacobian.diagonal(no_force, column, 3, 1.0 / scale_.force);
      no_force += 3;
    } else {
      const FrictionLimit& limit = friction_[i];
      jacobian.block(cone, column, (limit.slopes(f) / scale_.force).eval());
      cone += limit.count();
    }
  }
  jacobian.block(moment_row, at.com, (-per_moment * so3::skew(total)).eval());
}

void CentroidalNode::add_kinematics(const CentroidalPoint& point, const Matrix3d& Jr, SparseEntries& jacobian) {
  const int k = point.node;
  const CentroidalColumns& at = columns(k);
  const int momentum_row = first_row(k, momentum), com_row = first_row(k, com), joints = nv_ - 6;
  const double per_momentum = -1.0 / scale_.momentum, per_length = -1.0 / scale_.length;
  jacobian.diagonal(momentum_row, at.momentum, 3, 1.0 / scale_.momentum);
  add_q(momentum_row, kinematics_.momentum_dq().bottomRows<3>(), Jr, per_momentum, jacobian);
  jacobian.block(momentum_row, 6, per_momentum * kinematics_.momentum_dq().bottomRightCorner(3, joints));
  // Independent of the base's linear velocity.
  jacobian.block(momentum_row, at.v + 3, per_momentum * kinematics_.momentum_dv().bottomRightCorner(3, nv_ - 3));

  jacobian.diagonal(com_row, at.com, 3, 1.0 / scale_.length);
  jacobian.diagonal(com_row, 0, 3, per_length);
  add_q(com_row, kinematics_.com_dq(), Jr, per_length, jacobian);
  jacobian.block(com_row, 6, per_length * kinematics_.com_dq().rightCols(joints));

  for (int i = 0; i < num_contacts(); ++i) {
    const int row = first_row(k, positions) + 3 * i;
    const auto dq = points_.positions_dq().middleRows<3>(3 * i);
    jacobian.diagonal(row, at.contacts + 3 * i, 3, 1.0 / scale_.length);
    jacobian.diagonal(row, 0, 3, per_length);
    add_q(row, dq, Jr, per_length, jacobian);
    for (const int dof : terms_.contact_chain(contact_indices_[i])) {
      if (dof >= 6) jacobian.block(row, dof, per_length * dq.col(dof));
    }
  }
}

void CentroidalNode::add_limits(const CentroidalPoint& point, const Matrix3d& Jr, SparseEntries& jacobian) {
  const int k = point.node;
  const CentroidalColumns& at = columns(k);
  for (int i = 0; i < count(k, distance); ++i) {
    const HeldDirection& held = directions(k)[i];
    jacobian.block(first_row(k, distance) + i, at.contacts + 3 * held.contact, held.axis.transpose() / scale_.length);
  }
  if (count(k, com_velocity) > 0) {
    const int row = first_row(k, com_velocity);
    const double per_momentum = -1.0 / (mass_ * scale_.speed);
    jacobian.diagonal(row, at.com_velocity, 3, 1.0 / scale_.speed);
    add_q(row, kinematics_.momentum_dq().topRows<3>(), Jr, per_momentum, jacobian);
    jacobian.block(row, 6, per_momentum * kinematics_.momentum_dq().topRightCorner(3, nv_ - 6));
    jacobian.block(row, at.v, per_momentum * kinematics_.momentum_dv().topRows<3>());
  }
  const int row = first_row(k, placement), rows = count(k, placement);
  if (rows == 0) return;
  placement_dq_.resize(rows, nv_);
  placement_dv_.resize(rows, nv_);
  placement_dc_.resize(rows, 3 * num_contacts());
  placement_.derivatives(k, placement_dq_, placement_dv_, placement_dc_);
  jacobian.block(row, 0, placement_dq_.leftCols<3>());
  add_q(row, placement_dq_, Jr, 1.0, jacobian);
  jacobian.block(row, 6, placement_dq_.rightCols(nv_ - 6));
  if (k > 0) return;  // only clearance
  jacobian.block(row, at.v, placement_dv_);
  jacobian.block(row, at.contacts, placement_dc_);
}

void CentroidalNode::hessian(const CentroidalPoint& point, double cost_factor, const VectorXd& multipliers,
                             MatrixXd& result) {
  const int k = point.node;
  const CentroidalColumns& at = columns(k);
  result.setZero(at.size + 1, at.size + 1);
  MatrixXd cost = MatrixXd::Zero(3 * nv_ + nu_, 3 * nv_ + nu_);  // blocks of (q | v | a | tau)
  cost_.add_hessian(cost_point_, cost_factor, cost);
  result.topLeftCorner(2 * nv_, 2 * nv_) = cost.topLeftCorner(2 * nv_, 2 * nv_);
  auto qq = result.topLeftCorner(nv_, nv_);
  auto qv = result.block(0, at.v, nv_, nv_);

  SpatialVector on_momentum = SpatialVector::Zero();
  on_momentum.tail<3>() = -multipliers.segment<3>(first_row(k, momentum)) / scale_.momentum;
  if (count(k, com_velocity) > 0) {
    on_momentum.head<3>() = -multipliers.segment<3>(first_row(k, com_velocity)) / (mass_ * scale_.speed);
  }
  const Vector3d on_com = -multipliers.segment<3>(first_row(k, com)) / scale_.length;
  kinematics_.add_hessian(on_com, on_momentum, qq, qv);
  points_.add_position_hessian(multipliers.segment(first_row(k, positions), count(k, positions)), -1.0 / scale_.length,
                               qq);
  MatrixXd vq = MatrixXd::Zero(nv_, nv_);
  placement_.add_hessian(k, multipliers.segment(first_row(k, placement), count(k, placement)), qq, vq);
  qv += vq.transpose();

  const Vector3d pull = cost_factor * rotation_gradient_ + rotation_.transpose() * multipliers;
  const Matrix3d Jr = so3::right_jacobian(point.x.segment<3>(3));
  qq.middleRows<3>(3) = (Jr.transpose() * qq.middleRows<3>(3)).eval();
  qv.middleRows<3>(3) = (Jr.transpose() * qv.middleRows<3>(3)).eval();
  qq.middleCols<3>(3) = (qq.middleCols<3>(3) * Jr).eval();
  qq.block<3, 3>(3, 3) += so3::right_jacobian_derivative(point.x.segment<3>(3), pull);
  if (at.ends_interval()) {
    result.diagonal().segment<3>(at.com_acceleration) = cost.diagonal().segment<3>(2 * nv_);
    const Matrix3d turned = so3::skew(multipliers.segment<3>(first_row(k, moment)) / (scale_.force * scale_.length));
    int cone = first_row(k, friction);
    for (int i = 0; i < num_contacts(); ++i) {
      const int column = at.forces + 3 * i;
      result.block<3, 3>(at.com, column) = -turned;
      result.block<3, 3>(at.contacts + 3 * i, column) = turned;
      result.block<3, 3>(column, column).diagonal() = cost_factor * cost_.force_curvature(cost_point_);
      if (unloads(k, i)) continue;
      const FrictionLimit& limit = friction_[i];
      const VectorXd on_rows = multipliers.segment(cone, limit.count()) / scale_.force;
      result.block<3, 3>(column, column) += limit.curvature(forces_.segment<3>(3 * i), on_rows);
      cone += limit.count();
    }
    const double factor = cost_factor / point.duration;  // the running cost is proportional to the duration
    result.col(at.size).head(nv_) = factor * cost_slope_.running_gradient.head(nv_);
    result.col(at.size).segment<3>(3) = (Jr.transpose() * result.col(at.size).segment<3>(3)).eval();
    result.col(at.size).segment(at.v, nv_) = factor * cost_slope_.running_gradient.segment(nv_, nv_);
    result.col(at.size).segment<3>(at.com_acceleration) = factor * cost_slope_.running_gradient.segment<3>(2 * nv_);
    result.col(at.size).segment(at.forces, forces_.size()) = factor * cost_slope_.force_gradient;
  }
  result.triangularView<Eigen::StrictlyLower>() = result.transpose();
}

void CentroidalNode::mark_hessian(int k, Eigen::Matrix<bool, Eigen::Dynamic, Eigen::Dynamic>& marks) const {
  const CentroidalColumns& at = columns(k);
  marks.setConstant(at.size, at.size, false);
  marks.block(3, 3, nv_ - 3, nv_ - 3).setConstant(true);
  if (positions_cost_) marks.topLeftCorner(nv_, nv_).setConstant(true);
  marks.diagonal().head(2 * nv_).setConstant(true);
  marks.block(3, at.v + 3, nv_ - 3, nv_ - 3).setConstant(true);
  marks.block<3, 3>(3, at.v).setConstant(true);
  marks.block<3, 3>(at.v + 3, at.v + 3).setConstant(true);
  for (int i = 0; at.ends_interval() && i < num_contacts(); ++i) {
    const int column = at.forces + 3 * i;
    marks.block<3, 3>(column, column).setConstant(true);
    marks.block<3, 3>(at.com, column).setConstant(true);
    marks.block<3, 3>(at.contacts + 3 * i, column).setConstant(true);
  }
  if (at.ends_interval()) marks.diagonal().segment<3>(at.com_acceleration).setConstant(true);
  for (int i = 0; i < at.size; ++i) {
    for (int j = 0; j < i; ++j) marks(i, j) = marks(j, i);
  }
}

}  // namespace prowl
