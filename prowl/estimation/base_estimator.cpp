#include "prowl/estimation/base_estimator.hpp"

#include <Eigen/Cholesky>

#include "prowl/model/configuration.hpp"
#include "prowl/model/so3.hpp"

namespace prowl {
namespace {

// Rows of the parts of the error state.
constexpr Eigen::Index kPosition = 0, kVelocity = 3, kRotation = 6, kAccelerometer = 9, kGyro = 12, kFeet = 15;
constexpr double kGate = 21.1;        // chi square of 3 degrees of freedom, 99.99 %
constexpr int kMostRejected = 20;     // measurements in a row; after these the foot has moved
constexpr double kKinematics = 1e-4;  // [m]; error of foot positions besides the encoders' noise

Eigen::Index foot_row(std::size_t foot) { return kFeet + 3 * static_cast<Eigen::Index>(foot); }

}  // namespace

BaseEstimator::BaseEstimator(const RobotModel& robot, const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                             const std::vector<bool>& in_contact, const EstimatorNoise& noise)
    : noise_(noise),
      legs_(robot),
      position_(base_position(q)),
      velocity_(base_rotation(q) * v.head<3>()),
      rotation_(base_rotation(q)),
      angular_velocity_(v.segment<3>(3)),
      feet_(robot.contacts().size()) {
  covariance_.setZero(foot_row(feet_.size()), foot_row(feet_.size()));
  covariance_.diagonal().segment<3>(kPosition).setConstant(noise.start_position * noise.start_position);
  covariance_.diagonal().segment<3>(kVelocity).setConstant(noise.start_velocity * noise.start_velocity);
  covariance_.diagonal().segment<3>(kRotation).setConstant(noise.start_angle * noise.start_angle);
  covariance_.diagonal().segment<3>(kAccelerometer).setConstant(noise.accelerometer_bias * noise.accelerometer_bias);
  covariance_.diagonal().segment<3>(kGyro).setConstant(noise.gyro_bias * noise.gyro_bias);
  legs_.update(q.tail(robot.nu()));
  for (std::size_t c = 0; c < feet_.size(); ++c) {
    feet_[c].radius = robot.contacts()[c].radius;
    if (!in_contact[c]) continue;
    // It has stood for long, where the plan puts it: the base may be elsewhere.
    feet_[c].stands = true;
    feet_[c].since = noise.landing;
    feet_[c].foothold = position_ + rotation_ * legs_.position(static_cast<int>(c));
    covariance_.diagonal().segment<3>(foot_row(c)).setConstant(noise.start_foothold * noise.start_foothold);
    covariance_(foot_row(c) + 2, foot_row(c) + 2) = noise.start_ground * noise.start_ground;
  }
}

void BaseEstimator::update(double dt, const Eigen::Vector3d& gyro, const Eigen::Vector3d& accelerometer,
                           const Eigen::VectorXd& encoders, const Eigen::VectorXd& joint_rates,
                           const std::vector<bool>& in_contact, const std::vector<Eigen::Vector3d>& normals) {
  predict(dt, gyro, accelerometer, joint_rates, normals);
  legs_.update(encoders);
  for (std::size_t c = 0; c < feet_.size(); ++c) {
    if (in_contact[c] && !feet_[c].stands) put_down(static_cast<int>(c));
    if (!in_contact[c] && feet_[c].stands) lift(static_cast<int>(c));
  }
  correct();
  angular_velocity_ = gyro - gyro_bias_;
}

void BaseEstimator::predict(double dt, const Eigen::Vector3d& gyro, const Eigen::Vector3d& accelerometer,
                            const Eigen::VectorXd& joint_rates, const std::vector<Eigen::Vector3d>& normals) {
  const Eigen::Vector3d w = gyro - gyro_bias_, f = accelerometer - accelerometer_bias_;
  const Eigen::Matrix3d middle =
      rotation_ * so3::exp(0.5 * dt * w);  // f is a mean: use the orientation at mid-interval
  const Eigen::Vector3d a = middle * f - Eigen::Vector3d(0.0, 0.0, RobotModel::kGravity);

  Eigen::MatrixXd F = Eigen::MatrixXd::Identity(kFeet, kFeet);
  F.block<3, 3>(kPosition, kVelocity).diagonal().setConstant(dt);
  F.block<3, 3>(kVelocity, kRotation) = -dt * middle * so3::skew(f);
  F.block<3, 3>(kVelocity, kAccelerometer) = -dt * middle;
  F.block<3, 3>(kRotation, kRotation) = so3::exp(-dt * w);
  F.block<3, 3>(kRotation, kGyro).diagonal().setConstant(-dt);
  covariance_.topRows<kFeet>() = F * covariance_.topRows<kFeet>().eval();
  covariance_.leftCols<kFeet>() = covariance_.leftCols<kFeet>().eval() * F.transpose();
  const double velocity = dt * noise_.accelerometer, turn = dt * noise_.gyro;
  covariance_.diagonal().segment<3>(kVelocity).array() += velocity * velocity;
  covariance_.diagonal().segment<3>(kRotation).array() += turn * turn;

  for (std::size_t c = 0; c < feet_.size(); ++c) {
    Foot& foot = feet_[c];
    if (!foot.stands) continue;
    const Eigen::Vector3d spin = rotation_ * (w + legs_.angular(static_cast<int>(c)) * joint_rates);
    foot.foothold += dt * spin.cross(foot.radius * normals[c]);
    const double wander = foot.since < noise_.landing ? noise_.landing_foot : noise_.foot;
    covariance_.diagonal().segment<3>(foot_row(c)).array() += wander * wander * dt;
    foot.since += dt;
  }
  position_ += dt * velocity_ + 0.5 * dt * dt * a;
  velocity_ += dt * a;
  rotation_ = rotation_ * so3::exp(dt * w);
}

void BaseEstimator::put_down(int contact) {
  lift(contact);
  feet_[contact].stands = true;
  feet_[contact].since = 0.0;
  feet_[contact].foothold = position_ + rotation_ * legs_.position(contact);
  // c = p + R s + R n:  δc = δp - R [s]× δθ + R n
  const Eigen::Index row = foot_row(contact);
  const Eigen::Matrix3d turn = -rotation_ * so3::skew(legs_.position(contact));
  covariance_.middleRows<3>(row) = covariance_.middleRows<3>(kPosition) + turn * covariance_.middleRows<3>(kRotation);
  covariance_.middleCols<3>(row) =
      covariance_.middleCols<3>(kPosition) + covariance_.middleCols<3>(kRotation) * turn.transpose();
  const Eigen::Matrix3Xd J = noise_.encoder * rotation_ * legs_.linear(contact);
  covariance_.block<3, 3>(row, row) += J * J.transpose();
  covariance_.diagonal().segment<3>(row).array() += kKinematics * kKinematics;
}

void BaseEstimator::lift(int contact) {
  feet_[contact].stands = false;
  feet_[contact].rejected = 0;
  covariance_.middleRows<3>(foot_row(contact)).setZero();
  covariance_.middleCols<3>(foot_row(contact)).setZero();
}

/// One foot after the other: their noise is independent, so the result is that of all at once.
void BaseEstimator::correct() {
  for (std::size_t c = 0; c < feet_.size(); ++c) {
    Foot& foot = feet_[c];
    if (!foot.stands || foot.since == 0.0) continue;
    const int contact = static_cast<int>(c);
    const Eigen::Vector3d expected = rotation_.transpose() * (foot.foothold - position_);
    const Eigen::Vector3d innovation = legs_.position(contact) - expected;
    // P H' with H = (-R', 0, [expected]×, 0, 0, ..., R')
    const Eigen::MatrixXd PHt =
        (covariance_.middleCols<3>(foot_row(c)) - covariance_.middleCols<3>(kPosition)) * rotation_ -
        covariance_.middleCols<3>(kRotation) * so3::skew(expected);
    Eigen::Matrix3d S = rotation_.transpose() * (PHt.middleRows<3>(foot_row(c)) - PHt.middleRows<3>(kPosition)) +
                        so3::skew(expected) * PHt.middleRows<3>(kRotation);
    const Eigen::Matrix3Xd J = noise_.encoder * legs_.linear(contact);
    S += J * J.transpose();
    S.diagonal().array() += kKinematics * kKinematics;
    const Eigen::LLT<Eigen::Matrix3d> factor(S);
    if (innovation.dot(factor.solve(innovation)) > kGate) {
      if (++foot.rejected >= kMostRejected) put_down(contact);
      continue;
    }
    foot.rejected = 0;
    const Eigen::MatrixXd gain_t = factor.solve(PHt.transpose());
    covariance_ -= PHt * gain_t;
    covariance_ = 0.5 * (covariance_ + covariance_.transpose()).eval();
    apply(gain_t.transpose() * innovation);
  }
}

void BaseEstimator::apply(const Eigen::VectorXd& error) {
  position_ += error.segment<3>(kPosition);
  velocity_ += error.segment<3>(kVelocity);
  rotation_ = rotation_ * so3::exp(error.segment<3>(kRotation));
  accelerometer_bias_ += error.segment<3>(kAccelerometer);
  gyro_bias_ += error.segment<3>(kGyro);
  for (std::size_t c = 0; c < feet_.size(); ++c) {
    if (feet_[c].stands) feet_[c].foothold += error.segment<3>(foot_row(c));
  }
}

}  // namespace prowl
