#include "alternatives/centroidal/centroidal_interval.hpp"

namespace prowl {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kTwice = 2.0;  ///< the trapezoid over 2 dt with v0 = 0 is backward Euler over dt

IntervalEnd moving(const CentroidalInterval::End& end, const VectorXd& v) {
  return {end.chart, end.x.head(v.size()), v, VectorXd::Zero(v.size())};
}

}  // namespace

CentroidalInterval::CentroidalInterval(const CentroidalScale& scale, const std::vector<HeldDirection>& sliding,
                                       const VectorXd& weight, End start, End end, double step)
    : scale_(scale),
      sliding_(sliding),
      weight_(weight),
      start_(std::move(start)),
      end_(std::move(end)),
      step_(step),
      nv_(static_cast<int>(weight.size())),
      change_(end_.x.segment(end_.columns.v, nv_) - start_.x.segment(start_.columns.v, nv_)),
      euler_(moving(start_, VectorXd::Zero(nv_)), moving(end_, end_.x.segment(end_.columns.v, nv_)), kTwice * step) {
  change_.head<3>().setZero();
}

std::vector<RowGroup> CentroidalInterval::row_groups(int nv, int sliding) {
  return {{"q by backward Euler", nv},
          {"h by backward Euler", 3},
          {"r by the trapezoid", 3},
          {"r' by backward Euler", 3},
          {"contacts do not slide", sliding}};
}

VectorXd CentroidalInterval::rows() const {
  const CentroidalColumns &at0 = start_.columns, &at1 = end_.columns;
  VectorXd rows(num_rows(nv_, static_cast<int>(sliding_.size())));
  rows.head(nv_) = euler_.value().head(nv_);
  rows.segment<3>(nv_) =
      (of(end_, at1.momentum) - of(start_, at0.momentum) - step_ * of(end_, at1.momentum_rate)) / scale_.momentum;
  rows.segment<3>(nv_ + 3) = (of(end_, at1.com) - of(start_, at0.com) -
                              0.5 * step_ * (of(start_, at0.com_velocity) + of(end_, at1.com_velocity))) /
                             scale_.length;
  rows.segment<3>(nv_ + 6) =
      (of(end_, at1.com_velocity) - of(start_, at0.com_velocity) - step_ * of(end_, at1.com_acceleration)) /
      scale_.speed;
  for (std::size_t i = 0; i < sliding_.size(); ++i) {
    const int contact = 3 * sliding_[i].contact;
    const Vector3d moved = of(end_, at1.contacts + contact) - of(start_, at0.contacts + contact);
    rows(nv_ + 9 + static_cast<Index>(i)) = sliding_[i].axis.dot(moved) / scale_.length;
  }
  return rows;
}

void CentroidalInterval::add_jacobian(int row, int start, int end, int duration, double share,
                                      SparseEntries& jacobian) const {
  const CentroidalColumns &at0 = start_.columns, &at1 = end_.columns;
  const BaseDefects::Matrix3x12 rotation = euler_.rotation_derivative();  // theta0, w0, theta1, w1
  jacobian.diagonal(row, start, 3, -1.0);
  jacobian.diagonal(row, end, 3, 1.0);
  jacobian.block(row, end + 3, euler_.position_dtheta(1));
  jacobian.block(row, end + at1.v, euler_.position_dv(1));
  jacobian.block(row + 3, start + 3, rotation.leftCols<3>());
  jacobian.block(row + 3, end + 3, rotation.middleCols<3>(6));
  jacobian.block(row + 3, end + at1.v + 3, rotation.rightCols<3>());
  jacobian.diagonal(row + 6, start + 6, nv_ - 6, -1.0);
  jacobian.diagonal(row + 6, end + 6, nv_ - 6, 1.0);
  jacobian.diagonal(row + 6, end + at1.v + 6, nv_ - 6, -step_);

  const auto difference = [&](int first_row, int column0, int column1, double scale) {
    jacobian.diagonal(first_row, start + column0, 3, -1.0 / scale);
    jacobian.diagonal(first_row, end + column1, 3, 1.0 / scale);
  };
  difference(row + nv_, at0.momentum, at1.momentum, scale_.momentum);
  jacobian.diagonal(row + nv_, end + at1.momentum_rate, 3, -step_ / scale_.momentum);
  difference(row + nv_ + 3, at0.com, at1.com, scale_.length);
  jacobian.diagonal(row + nv_ + 3, start + at0.com_velocity, 3, -0.5 * step_ / scale_.length);
  jacobian.diagonal(row + nv_ + 3, end + at1.com_velocity, 3, -0.5 * step_ / scale_.length);
  difference(row + nv_ + 6, at0.com_velocity, at1.com_velocity, scale_.speed);
  jacobian.diagonal(row + nv_ + 6, end + at1.com_acceleration, 3, -step_ / scale_.speed);
  for (std::size_t i = 0; i < sliding_.size(); ++i) {
    const Eigen::RowVector3d axis = sliding_[i].axis.transpose() / scale_.length;
    const int slide = row + nv_ + 9 + static_cast<int>(i), contact = 3 * sliding_[i].contact;
    jacobian.block(slide, start + at0.contacts + contact, -axis);
    jacobian.block(slide, end + at1.contacts + contact, axis);
  }
  if (duration < 0) return;
  VectorXd slope(nv_ + 9);
  slope << kTwice * euler_.d_step().head(nv_), -of(end_, at1.momentum_rate) / scale_.momentum,
      -0.5 * (of(start_, at0.com_velocity) + of(end_, at1.com_velocity)) / scale_.length,
      -of(end_, at1.com_acceleration) / scale_.speed;
  jacobian.block(row, duration, share * slope);
}

double CentroidalInterval::cost() const { return 0.5 * weight_.dot(change_.cwiseAbs2()) / step_; }

void CentroidalInterval::add_cost_gradient(Eigen::Ref<VectorXd> start, Eigen::Ref<VectorXd> end, double& step) const {
  const VectorXd slope = weight_.cwiseProduct(change_) / step_;
  start.segment(start_.columns.v, nv_) -= slope;
  end.segment(end_.columns.v, nv_) += slope;
  step -= cost() / step_;
}

CentroidalInterval::Between CentroidalInterval::add_hessian(double cost_factor, const VectorXd& multipliers,
                                                            double share, MatrixXd& start, MatrixXd& end) const {
  const CentroidalColumns &at0 = start_.columns, &at1 = end_.columns;
  VectorXd on_q = VectorXd::Zero(2 * nv_);
  on_q.head(nv_) = multipliers.head(nv_);
  const IntervalDefects::Hessian bent = euler_.hessian(on_q);
  start.block<3, 3>(3, 3) += bent.turn[0].topLeftCorner<3, 3>();
  const auto turning = [&](int i) { return i < 3 ? 3 + i : at1.v + i; };  // theta, angular velocity
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) end(turning(i), turning(j)) += bent.turn[1](i, j);
  }
  end.block<3, 3>(3, at1.v) += bent.theta_v[1];
  end.block<3, 3>(at1.v, 3) += bent.theta_v[1].transpose();

  VectorXd weight = cost_factor / step_ * weight_;
  weight.head<3>().setZero();
  start.diagonal().segment(at0.v, nv_) += weight;
  end.diagonal().segment(at1.v, nv_) += weight;

  // Derivatives in the step: the duration is the last variable of both ends.
  VectorXd step0 = VectorXd::Zero(at0.size), step1 = VectorXd::Zero(at1.size);
  const VectorXd slope = weight.cwiseProduct(change_) / step_;
  step0.segment<3>(3) = kTwice * bent.step[0].segment<3>(3);
  step0.segment(at0.v, nv_) = slope;
  step0.segment<3>(at0.com_velocity) = -0.5 * multipliers.segment<3>(nv_ + 3) / scale_.length;
  step1.head(nv_) = kTwice * bent.step[1].head(nv_);
  step1.segment(at1.v, nv_) = kTwice * bent.step[1].segment(nv_, nv_) - slope;
  step1.segment<3>(at1.momentum_rate) = -multipliers.segment<3>(nv_) / scale_.momentum;
  step1.segment<3>(at1.com_velocity) = step0.segment<3>(at0.com_velocity);
  step1.segment<3>(at1.com_acceleration) = -multipliers.segment<3>(nv_ + 6) / scale_.speed;
  start.row(at0.size).head(at0.size) += share * step0.transpose();
  end.row(at1.size).head(at1.size) += share * step1.transpose();
  end(at1.size, at1.size) +=
      share * share * (kTwice * kTwice * bent.step_step + 2.0 * cost_factor * cost() / (step_ * step_));
  return {bent.link.leftCols<3>(), -weight};
}

}  // namespace prowl
