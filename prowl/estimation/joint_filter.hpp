#pragma once

#include <Eigen/Core>

namespace prowl {

/// Joint positions and rates from encoders: one two-state Kalman filter for all joints, which share their noise.
///
///   q' = v,  v' = a + w,  y = q + n
///
/// a is the model's acceleration from the commanded torques [rad/s²], w white noise of density S [rad²/s³], the error
/// of the model. The bandwidth is (S / (σ² dt))^(1/4) rad/s. Differences of encoder samples have noise σ √2 / dt: 1.4
/// rad/s for 1 mrad at 1 kHz.
class JointFilter {
 public:
  /// Starts at positions and rates with these standard deviations [rad, rad/s]. `noise` σ > 0 [rad] a sample, `density`
  /// S.
  JointFilter(const Eigen::VectorXd& positions, const Eigen::VectorXd& rates, double noise, double density,
              double start_position = 0.0, double start_rate = 0.0);

  /// Advances by dt [s] with the expected acceleration, then corrects with a sample of the encoders.
  void update(double dt, const Eigen::VectorXd& acceleration, const Eigen::VectorXd& encoders);

  const Eigen::VectorXd& positions() const { return positions_; }
  const Eigen::VectorXd& rates() const { return rates_; }
  const Eigen::Matrix2d& covariance() const { return covariance_; }  ///< of (position, rate), any joint

 private:
  double variance_, density_;
  Eigen::VectorXd positions_, rates_;
  Eigen::Matrix2d covariance_ = Eigen::Matrix2d::Zero();
};

}  // namespace prowl
