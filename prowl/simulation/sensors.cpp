#include "prowl/simulation/sensors.hpp"

#include <boost/random/normal_distribution.hpp>

#include "prowl/model/configuration.hpp"

namespace prowl {

Sensors::Sensors(int joints, const SensorNoise& noise, double scale, std::uint64_t seed)
    : deviation_{scale * noise.encoder, scale * noise.gyro, scale * noise.accelerometer}, random_(seed) {
  encoder_bias_ = this->noise(joints, deviation_.encoder);
  gyro_bias_ = this->noise(3, deviation_.gyro);
  accelerometer_bias_ = this->noise(3, deviation_.accelerometer);
}

void Sensors::integrate(double dt, const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& q_next,
                        const Eigen::VectorXd& v_next) {
  const Eigen::Matrix3d R = base_rotation(q), R_next = base_rotation(q_next);
  const Eigen::Vector3d change = R_next * v_next.head<3>() - R * v.head<3>();  // world axes
  velocity_change_ += R.transpose() * (change + Eigen::Vector3d(0.0, 0.0, RobotModel::kGravity * dt));
  turn_ += dt * v_next.segment<3>(3);  // semi-implicit Euler rotates with the new velocity
  time_ += dt;
}

SensorReading Sensors::read(const Eigen::VectorXd& q) {
  SensorReading reading;
  if (time_ > 0.0) {
    reading.gyro = turn_ / time_;
    reading.accelerometer = velocity_change_ / time_;
  } else {
    reading.gyro.setZero();
    reading.accelerometer = base_rotation(q).transpose() * Eigen::Vector3d(0.0, 0.0, RobotModel::kGravity);
  }
  turn_.setZero();
  velocity_change_.setZero();
  time_ = 0.0;
  const Eigen::Index joints = encoder_bias_.size();
  reading.encoders = q.tail(joints) + encoder_bias_ + noise(joints, deviation_.encoder);
  reading.gyro += gyro_bias_ + noise(3, deviation_.gyro);
  reading.accelerometer += accelerometer_bias_ + noise(3, deviation_.accelerometer);
  return reading;
}

Eigen::VectorXd Sensors::noise(Eigen::Index size, double deviation) {
  boost::random::normal_distribution<double> normal;  // stateless between numbers
  Eigen::VectorXd values(size);
  for (double& value : values) value = deviation * normal(random_);
  return values;
}

}  // namespace prowl
