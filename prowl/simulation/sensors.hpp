#pragma once

#include <Eigen/Core>
#include <random>

#include "prowl/estimation/state_estimator.hpp"
#include "prowl/simulation/simulation_options.hpp"

namespace prowl {

/// Joint encoders and an IMU in the base frame. The IMU returns means over the time between two
/// readings, like integrating sensors. Noise: std::mt19937_64 with Boost's normal distribution,
/// which unlike std::normal_distribution is the same with every standard library.
class Sensors {
 public:
  /// `scale`: factor on all noise.
  Sensors(int joints, const SensorNoise& noise, double scale, std::uint64_t seed);

  /// One physics step of `dt` [s], from (q, v) to (q_next, v_next).
  void integrate(double dt, const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& q_next,
                 const Eigen::VectorXd& v_next);
  /// Reads the sensors at q and starts the next IMU interval. Before the first step the IMU reads
  /// rest at q.
  SensorReading read(const Eigen::VectorXd& q);

 private:
  Eigen::VectorXd noise(Eigen::Index size, double deviation);

  SensorNoise deviation_;
  std::mt19937_64 random_;
  Eigen::VectorXd encoder_bias_;
  Eigen::Vector3d gyro_bias_, accelerometer_bias_;
  Eigen::Vector3d turn_ = Eigen::Vector3d::Zero(), velocity_change_ = Eigen::Vector3d::Zero();
  double time_ = 0.0;
};

}  // namespace prowl
