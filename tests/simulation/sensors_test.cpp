#include "prowl/simulation/sensors.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/robots.hpp"

namespace prowl {
namespace {

/// Samples at rest: their mean is truth and bias, their spread the noise.
TEST(Sensors, HaveTheirNoiseAndOneBias) {
  const SensorNoise noise;
  const Eigen::VectorXd q = test::hyq().nominal_configuration();
  const int samples = 4000, joints = 12;
  double bias_squares = 0.0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Sensors sensors(joints, noise, 1.0, seed);
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(joints), squares = sum;
    for (int i = 0; i < samples; ++i) {
      const Eigen::VectorXd off = sensors.read(q).encoders - q.tail(joints);
      sum += off;
      squares += off.cwiseAbs2();
    }
    const Eigen::VectorXd mean = sum / samples;
    const Eigen::VectorXd deviation = (squares / samples - mean.cwiseAbs2()).cwiseSqrt();
    EXPECT_NEAR(deviation.mean(), noise.encoder, 0.02 * noise.encoder);
    bias_squares += mean.squaredNorm() / joints / 20;
  }
  EXPECT_NEAR(std::sqrt(bias_squares), noise.encoder, 0.15 * noise.encoder);
}

/// What integrates the IMU's samples gets back velocity and turn, whatever happened in between.
TEST(Sensors, GiveMeansOfTheTimeBetween) {
  Sensors sensors(0, {}, 0.0, 1);
  Eigen::VectorXd q(7), v = Eigen::VectorXd::Zero(6);
  q << 0, 0, 1, 0, 0, 0, 1;
  EXPECT_NEAR(sensors.read(q).accelerometer.z(), RobotModel::kGravity, 1e-12);
  Eigen::VectorXd next = v;
  for (int i = 0; i < 4; ++i) {
    next(0) += 0.01 * (i + 1);  // uneven steps to 0.1 m/s
    sensors.integrate(2.5e-4, q, v, q, next);
    v = next;
  }
  const SensorReading reading = sensors.read(q);
  EXPECT_NEAR(reading.accelerometer.x(), 0.1 / 1e-3, 1e-9);
  EXPECT_NEAR(reading.accelerometer.z(), RobotModel::kGravity, 1e-9);
}

}  // namespace
}  // namespace prowl
