#pragma once

#include <Eigen/Core>

namespace prowl {

/// Joint positions and rates from encoders: one Kalman filter of two states for all joints, as they share their noise.
///
///   q' = v,  v' = a + w,  y = q + n
///
/// a is the acceleration that the model expects of the commanded torques [rad/s^2], w white noise of density S
/// [rad^2/s^3]: what the model does not know. Its bandwidth is (S / (σ² dt))^(1/4) rad/s; differences of encoder
/// samples, by contrast, have σ √2 / dt: 1.4 rad/s for 1 mrad at 1 kHz.
class JointFilter {
 public:
  /// Starts at known positions and at rest. `noise` σ > 0 [rad] a sample, `density` S.
  JointFilter(const Eigen::VectorXd& positions, double noise, double density);

  /// dt seconds on, with the acceleration expected for that time, then a sample of the encoders.
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
