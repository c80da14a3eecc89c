#pragma once

#include <Eigen/Core>
#include <random>

#include "prowl/estimation/state_estimator.hpp"
#include "prowl/simulation/simulation_options.hpp"

namespace prowl {

/// Encoders and an IMU in the base frame. The IMU gives means over the time between two samples, as those that
/// integrate inside do. The random numbers are those of std::mt19937_64 and of Boost's normal distribution, whose
/// result, unlike that of std::normal_distribution, does not depend on the standard library.
class Sensors {
 public:
  Sensors(int joints, const SensorNoise& noise, double scale, std::uint64_t seed);

  /// One physics step of `dt`, from (q, v) to (q_next, v_next).
  void integrate(double dt, const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& q_next,
                 const Eigen::VectorXd& v_next);
  /// At configuration q; starts the next interval of the IMU. Before the first step, what the IMU says at rest at q.
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
