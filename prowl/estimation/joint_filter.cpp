#include "prowl/estimation/joint_filter.hpp"

namespace prowl {

JointFilter::JointFilter(const Eigen::VectorXd& positions, const Eigen::VectorXd& rates, double noise, double density,
                         double start_position, double start_rate)
    : variance_(noise * noise), density_(density), positions_(positions), rates_(rates) {
  covariance_.diagonal() << start_position * start_position, start_rate * start_rate;
}

void JointFilter::update(double dt, const Eigen::VectorXd& acceleration, const Eigen::VectorXd& encoders) {
  positions_ += dt * rates_ + 0.5 * dt * dt * acceleration;
  rates_ += dt * acceleration;
  Eigen::Matrix2d F, Q;
  F << 1.0, dt, 0.0, 1.0;
  Q << dt * dt * dt / 3.0, dt * dt / 2.0, dt * dt / 2.0, dt;
  covariance_ = F * covariance_ * F.transpose() + density_ * Q;

  const Eigen::Vector2d gain = covariance_.col(0) / (covariance_(0, 0) + variance_);
  const Eigen::VectorXd innovation = encoders - positions_;
  positions_ += gain(0) * innovation;
  rates_ += gain(1) * innovation;
  covariance_ -= gain * covariance_.row(0).eval();
  covariance_ = 0.5 * (covariance_ + covariance_.transpose()).eval();
}

}  // namespace prowl
