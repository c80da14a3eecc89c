#include "prowl/transcription/interval_defects.hpp"

namespace prowl {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

IntervalDefects::IntervalDefects(IntervalEnd start, IntervalEnd end, double h, const VectorXd& correction)
    : start_(std::move(start)),
      end_(std::move(end)),
      h_(h),
      correction_(correction.size() > 0 ? correction : VectorXd::Zero(2 * start_.v.size())),
      nv_(start_.v.size()),
      nu_(nv_ - 6),
      base_(start_.base(), end_.base(), h, correction_.segment<3>(3)) {}

VectorXd IntervalDefects::value() const {
  VectorXd value(2 * nv_);
  value.segment<3>(0) = base_.position();
  value.segment<3>(3) = base_.rotation();
  value.segment(6, nu_) = (end_.q - start_.q - 0.5 * h_ * (start_.v + end_.v)).tail(nu_);
  value.tail(nv_) = end_.v - start_.v - 0.5 * h_ * (start_.a + end_.a);
  value.head<3>() -= correction_.head<3>();
  value.tail(2 * nv_ - 6) -= correction_.tail(2 * nv_ - 6);
  return value;
}

// The rotation depends on h w only: its derivative in h is that in w along w / h.
VectorXd IntervalDefects::d_step() const {
  VectorXd slope(2 * nv_);
  const BaseDefects::Matrix3x12 rotation = base_.rotation_derivative();
  slope.segment<3>(0).setZero();
  slope.segment<3>(3).setZero();
  for (const int end : {0, 1}) {
    const WorldVelocity velocity(at(end).chart, at(end).q.segment<3>(3), at(end).v.segment<3>(0));
    slope.segment<3>(0) -= 0.5 * velocity.value;
    slope.segment<3>(3) += rotation.middleCols<3>(6 * end + 3) * at(end).v.segment<3>(3) / h_;
  }
  slope.segment(6, nu_) = -0.5 * (start_.v + end_.v).tail(nu_);
  slope.tail(nv_) = -0.5 * (start_.a + end_.a);
  return slope;
}

Matrix3d IntervalDefects::position_dtheta(int end) const {
  return -0.5 * h_ * WorldVelocity(at(end).chart, at(end).q.segment<3>(3), at(end).v.segment<3>(0)).d_theta;
}

Matrix3d IntervalDefects::position_dv(int end) const {
  return -0.5 * h_ * WorldVelocity(at(end).chart, at(end).q.segment<3>(3), at(end).v.segment<3>(0)).d_v;
}

IntervalDefects::Hessian IntervalDefects::hessian(const VectorXd& multipliers) const {
  const Vector3d on_position = multipliers.segment<3>(0), on_rotation = multipliers.segment<3>(3);
  const BaseDefects::Matrix12 rotation = base_.rotation_hessian(on_rotation);
  const Eigen::Matrix<double, 12, 1> gradient = base_.rotation_derivative().transpose() * on_rotation;
  Eigen::Matrix<double, 12, 1> turn = Eigen::Matrix<double, 12, 1>::Zero();  // (0, w0, 0, w1) / h
  for (const int end : {0, 1}) turn.segment<3>(6 * end + 3) = at(end).v.segment<3>(3) / h_;
  const Eigen::Matrix<double, 12, 1> turned = rotation * turn;

  Hessian result;
  result.link = rotation.bottomLeftCorner<6, 6>();
  result.step_step = turn.dot(turned);
  for (const int end : {0, 1}) {
    const IntervalEnd& here = at(end);
    const WorldVelocityHessian velocity(here.chart, here.q.segment<3>(3), here.v.segment<3>(0),
                                        -0.5 * h_ * on_position);
    result.turn[end] = rotation.block<6, 6>(6 * end, 6 * end);
    result.turn[end].topLeftCorner<3, 3>() += velocity.theta_theta;
    result.theta_v[end] = velocity.theta_v;

    VectorXd& step = result.step[end];
    step.setZero(3 * nv_);
    step.segment<3>(3) = position_dtheta(end).transpose() * on_position / h_ + turned.segment<3>(6 * end);
    step.segment<3>(nv_) = position_dv(end).transpose() * on_position / h_;
    step.segment<3>(nv_ + 3) = turned.segment<3>(6 * end + 3) + gradient.segment<3>(6 * end + 3) / h_;
    step.segment(nv_ + 6, nu_) = -0.5 * multipliers.segment(6, nu_);
    step.tail(nv_) = -0.5 * multipliers.tail(nv_);
  }
  return result;
}

}  // namespace prowl
