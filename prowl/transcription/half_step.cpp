#include "prowl/transcription/half_step.hpp"

#include "prowl/model/so3.hpp"
#include "prowl/transcription/congruence.hpp"

namespace prowl {

namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

using Turn = RotationProduct<2>;

/// theta' = log(charts exp(theta) exp(s omega)).
Turn turn(const Matrix3d& charts, const Vector3d& theta, const Matrix3d& between, double s, const Vector3d& omega) {
  return Turn({{{charts, theta}, {between, s * omega}}});
}

/// Adds a block to a Hessian above its diagonal, that is, its transpose below it. `block` may be an expression,
/// evaluated in place without heap allocation.
template <class Block>
void add_off_diagonal(MatrixXd& hessian, Index row, Index column, const Eigen::MatrixBase<Block>& block) {
  hessian.block<Block::ColsAtCompileTime, Block::RowsAtCompileTime>(column, row, block.cols(), block.rows()) +=
      block.transpose();
}

/// Adds the Hessian of lambda . s R v_linear in theta, v and the duration.
void add_moving(const WorldVelocity& world, const WorldVelocityHessian& bent, const Vector3d& lambda,
                const HalfTime& time, Index nv, MatrixXd& hessian) {
  hessian.block<3, 3>(3, 3) += time.s * bent.theta_theta;
  add_off_diagonal(hessian, 3, nv, time.s * bent.theta_v);
  if (time.column < 0) return;
  add_off_diagonal(hessian, 3, time.column, time.slope * world.d_theta.transpose() * lambda);
  add_off_diagonal(hessian, nv, time.column, time.slope * world.d_v.transpose() * lambda);
}

/// Adds the Hessian of lambda . theta' in theta, omega and the duration.
void add_turning(const Turn& turn, const Vector3d& lambda, const Vector3d& omega, const HalfTime& time, Index nv,
                 MatrixXd& hessian) {
  const Turn::Hessian bent = turn.hessian(lambda);
  const Matrix3d theta_x = bent.topRightCorner<3, 3>(), xx = bent.bottomRightCorner<3, 3>();
  hessian.block<3, 3>(3, 3) += bent.topLeftCorner<3, 3>();
  add_off_diagonal(hessian, 3, nv + 3, time.s * theta_x);
  hessian.block<3, 3>(nv + 3, nv + 3) += time.s * time.s * xx;
  if (time.column < 0) return;
  const Vector3d pull = turn.derivative().rightCols<3>().transpose() * lambda;
  add_off_diagonal(hessian, 3, time.column, time.slope * theta_x * omega);
  add_off_diagonal(hessian, nv + 3, time.column, time.slope * (time.s * xx * omega + pull));
  hessian(time.column, time.column) += time.slope * time.slope * omega.dot(xx * omega);
}

/// Adds the Hessian of lambda . s x; x: variables from `first` on.
void add_by_duration(Index first, const Eigen::Ref<const VectorXd>& lambda, const HalfTime& time, MatrixXd& hessian) {
  if (time.column >= 0) add_off_diagonal(hessian, first, time.column, time.slope * lambda);
}

/// Three columns times a matrix, in place, without heap allocation.
template <class Columns>
void substitute_three(Columns&& columns, const Matrix3d& by) {
  for (Index i = 0; i < columns.rows(); ++i) {
    const Eigen::RowVector3d row = columns.row(i);
    columns.row(i) = row * by;
  }
}

}  // namespace

void Arrival::set(const Matrix3d& chart, int nv, const HalfTime& time, const VectorXd& state,
                  const VectorXd& correction) {
  chart_ = chart;
  nv_ = nv;
  time_ = time;
  node_ = state;
  node_.head<3>() += correction.head<3>();
  node_.segment(6, 2 * nv_ - 6) += correction.tail(2 * nv_ - 6);
  node_.segment(nv_, nv_) += time.s * state.segment(2 * nv_, nv_);
  turn_ = turn(Matrix3d::Identity(), state.segment<3>(3), so3::exp(correction.segment<3>(3)), time.s,
               node_.segment<3>(nv_ + 3));
  slope_ = turn_.derivative();
  world_ = WorldVelocity(chart, turn_.value(), node_.segment<3>(nv_));
  node_.segment<3>(3) = turn_.value();
  node_.head<3>() += time.s * world_.value;
  node_.segment(6, nv_ - 6) += time.s * node_.segment(nv_ + 6, nv_ - 6);
}

VectorXd Arrival::state(const Matrix3d& chart, int nv, double s, const VectorXd& node, const VectorXd& correction) {
  VectorXd state = node;
  const WorldVelocity world(chart, node.segment<3>(3), node.segment<3>(nv));
  state.head<3>() -= s * world.value;
  state.segment<3>(3) = so3::log(so3::exp(node.segment<3>(3)) * so3::exp(-s * node.segment<3>(nv + 3)) *
                                 so3::exp(-correction.segment<3>(3)));
  state.segment(6, nv - 6) -= s * node.segment(nv + 6, nv - 6);
  state.segment(nv, nv) -= s * node.segment(2 * nv, nv);
  state.head<3>() -= correction.head<3>();
  state.segment(6, 2 * nv - 6) -= correction.tail(2 * nv - 6);
  return state;
}

// Substitutions of set(), last first. Each pulls derivatives (columns of `m`) back from its result
// to its arguments; s depends on the duration.

template <class Matrix>
void Arrival::substitute_position(Matrix&& m) const {
  const auto position = m.template leftCols<3>();
  if (time_.column >= 0) m.col(time_.column) += time_.slope * position.lazyProduct(world_.value);
  m.template middleCols<3>(3) += position.lazyProduct(time_.s * world_.d_theta);
  m.template middleCols<3>(nv_) += position.lazyProduct(time_.s * world_.d_v);
}

template <class Matrix>
void Arrival::substitute_joints(Matrix&& m) const {
  const Index nu = nv_ - 6;
  if (time_.column >= 0) {
    m.col(time_.column).noalias() += time_.slope * m.middleCols(6, nu) * node_.segment(nv_ + 6, nu);
  }
  m.middleCols(nv_ + 6, nu) += time_.s * m.middleCols(6, nu);
}

template <class Matrix>
void Arrival::substitute_rotation(Matrix&& m) const {
  auto rotation = m.template middleCols<3>(3);
  if (time_.column >= 0) {
    m.col(time_.column) += rotation.lazyProduct(time_.slope * slope_.rightCols<3>() * node_.segment<3>(nv_ + 3));
  }
  m.template middleCols<3>(nv_ + 3) += rotation.lazyProduct(time_.s * slope_.rightCols<3>());
  substitute_three(rotation, slope_.leftCols<3>());
}

template <class Matrix>
void Arrival::substitute_velocity(Matrix&& m) const {
  if (time_.column >= 0) {
    m.col(time_.column).noalias() += time_.slope * m.middleCols(nv_, nv_) * node_.segment(2 * nv_, nv_);
  }
  m.middleCols(2 * nv_, nv_) += time_.s * m.middleCols(nv_, nv_);
}

void Arrival::pull_back(MatrixXd& rows) const {
  substitute_position(rows);
  substitute_joints(rows);
  substitute_rotation(rows);
  substitute_velocity(rows);
}

void Arrival::pull_back(VectorXd& gradient) const {
  auto row = gradient.transpose();
  substitute_position(row);
  substitute_joints(row);
  substitute_rotation(row);
  substitute_velocity(row);
}

Arrival::JointRow Arrival::pull_back(JointRow row, Index dof) const {
  row.duration += time_.slope * row.q * node_(nv_ + dof);
  row.v += time_.s * row.q;
  row.duration += time_.slope * row.v * node_(2 * nv_ + dof);
  row.a += time_.s * row.v;
  return row;
}

void Arrival::substitute_position_in_form(MatrixXd& m) const {
  if (time_.column >= 0) add_vector(m, 0, time_.column, time_.slope, world_.value);
  add_block(m, 0, 3, time_.s * world_.d_theta);
  add_block(m, 0, nv_, time_.s * world_.d_v);
}

void Arrival::substitute_joints_in_form(MatrixXd& m) const {
  const Index nu = nv_ - 6;
  if (time_.column >= 0) add_vector(m, 6, time_.column, time_.slope, node_.segment(nv_ + 6, nu));
  add_multiple(m, 6, nv_ + 6, nu, time_.s);
}

void Arrival::substitute_rotation_in_form(MatrixXd& m) const {
  const Matrix3d by_omega = slope_.rightCols<3>();
  const Vector3d turning = by_omega * node_.segment<3>(nv_ + 3);
  if (time_.column >= 0) add_vector(m, 3, time_.column, time_.slope, turning);
  add_block(m, 3, nv_ + 3, time_.s * by_omega);
  replace_block(m, 3, slope_.leftCols<3>());
}

void Arrival::substitute_velocity_in_form(MatrixXd& m) const {
  if (time_.column >= 0) add_vector(m, nv_, time_.column, time_.slope, node_.segment(2 * nv_, nv_));
  add_multiple(m, nv_, 2 * nv_, nv_, time_.s);
}

void Arrival::pull_back_form(MatrixXd& m) const {
  substitute_position_in_form(m);
  substitute_joints_in_form(m);
  substitute_rotation_in_form(m);
  substitute_velocity_in_form(m);
}

void Arrival::pull_back_hessian(MatrixXd& hessian, VectorXd& gradient) const {
  auto g = gradient.transpose();
  substitute_position_in_form(hessian);
  const Vector3d on_position = gradient.head<3>();
  add_moving(world_, {chart_, turn_.value(), node_.segment<3>(nv_), on_position}, on_position, time_, nv_, hessian);
  substitute_position(g);

  substitute_joints_in_form(hessian);
  add_by_duration(nv_ + 6, gradient.segment(6, nv_ - 6), time_, hessian);
  substitute_joints(g);

  substitute_rotation_in_form(hessian);
  add_turning(turn_, gradient.segment<3>(3), node_.segment<3>(nv_ + 3), time_, nv_, hessian);
  substitute_rotation(g);

  substitute_velocity_in_form(hessian);
  add_by_duration(2 * nv_, gradient.segment(nv_, nv_), time_, hessian);
}

void Departure::set(const Matrix3d& chart, const Matrix3d& next_chart, int nv, const HalfTime& time,
                    const VectorXd& node) {
  chart_ = chart;
  nv_ = nv;
  time_ = time;
  node_ = node;
  turn_ =
      turn(next_chart.transpose() * chart, node.segment<3>(3), Matrix3d::Identity(), time.s, node.segment<3>(nv + 3));
  slope_ = turn_.derivative();
  world_ = WorldVelocity(chart, node.segment<3>(3), node.segment<3>(nv));
}

void Departure::value(Eigen::Ref<VectorXd> state) const {
  state = node_.head(2 * nv_);
  state.head<3>() += time_.s * world_.value;
  state.segment<3>(3) = turn_.value();
  state.segment(6, nv_ - 6) += time_.s * node_.segment(nv_ + 6, nv_ - 6);
  state.tail(nv_) += time_.s * node_.segment(2 * nv_, nv_);
}

void Departure::base_derivatives(Eigen::Ref<MatrixXd> rows) const {
  rows.setZero();
  rows.block<3, 3>(0, 0).setIdentity();
  rows.block<3, 3>(0, 3) = time_.s * world_.d_theta;
  rows.block<3, 3>(0, nv_) = time_.s * world_.d_v;
  rows.block<3, 3>(3, 3) = slope_.leftCols<3>();
  rows.block<3, 3>(3, nv_ + 3) = time_.s * slope_.rightCols<3>();
  if (time_.column < 0) return;
  rows.col(time_.column) << time_.slope * world_.value,
      time_.slope * (slope_.rightCols<3>() * node_.segment<3>(nv_ + 3));
}

Arrival::JointRow Departure::joint_derivatives(Index i) const {
  if (i < nv_) return {.q = 1.0, .v = time_.s, .duration = time_.slope * node_(nv_ + i)};
  return {.v = 1.0, .a = time_.s, .duration = time_.slope * node_(nv_ + i)};
}

void Departure::add_hessian(const VectorXd& multipliers, MatrixXd& hessian) const {
  const Vector3d on_position = multipliers.head<3>();
  add_moving(world_, {chart_, node_.segment<3>(3), node_.segment<3>(nv_), on_position}, on_position, time_, nv_,
             hessian);
  add_turning(turn_, multipliers.segment<3>(3), node_.segment<3>(nv_ + 3), time_, nv_, hessian);
  add_by_duration(nv_ + 6, multipliers.segment(6, nv_ - 6), time_, hessian);
  add_by_duration(2 * nv_, multipliers.segment(nv_, nv_), time_, hessian);
}

/// Turns columns of (z', w'), stored in place of (q, v), into those of the node.
template <class Matrix>
void Departure::substitute(Matrix&& m) const {
  const Index nu = nv_ - 6;
  const auto position = m.template leftCols<3>();
  auto rotation = m.template middleCols<3>(3);
  if (time_.column >= 0) {
    auto by_duration = m.col(time_.column);
    by_duration += time_.slope * position.lazyProduct(world_.value);
    by_duration += rotation.lazyProduct(time_.slope * slope_.rightCols<3>() * node_.segment<3>(nv_ + 3));
    by_duration.noalias() += time_.slope * m.middleCols(6, nu) * node_.segment(nv_ + 6, nu);
    by_duration.noalias() += time_.slope * m.middleCols(nv_, nv_) * node_.segment(2 * nv_, nv_);
  }
  m.middleCols(2 * nv_, nv_) += time_.s * m.middleCols(nv_, nv_);
  m.middleCols(nv_ + 6, nu) += time_.s * m.middleCols(6, nu);
  m.template middleCols<3>(nv_ + 3) += rotation.lazyProduct(time_.s * slope_.rightCols<3>());
  m.template middleCols<3>(nv_) += position.lazyProduct(time_.s * world_.d_v);
  substitute_three(rotation, slope_.leftCols<3>());
  rotation += position.lazyProduct(time_.s * world_.d_theta);
}

void Departure::pull_back(VectorXd& gradient) const { substitute(gradient.transpose()); }

}  // namespace prowl
