#include "prowl/estimation/state_estimator.hpp"

#include "prowl/error.hpp"
#include "prowl/model/configuration.hpp"

namespace prowl {

StateEstimator::StateEstimator(const RobotModel& robot, const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                               const Stand& stand, const EstimatorNoise& noise, double joint_density)
    : robot_(robot),
      joints_(q.tail(robot.nu()), v.tail(robot.nu()), noise.encoder, joint_density, noise.start_joint,
              noise.start_joint_rate),
      base_(robot, q, v, stand.in_contact, noise),
      q_(q),
      v_(v) {}

void StateEstimator::update(double dt, const SensorReading& reading, const Eigen::VectorXd& tau, const Stand& stand) {
  joints_.update(dt, acceleration(q_, v_, tau, stand).tail(robot_.nu()), reading.encoders);
  base_.update(dt, reading.gyro, reading.accelerometer, reading.encoders, joints_.rates(), stand.in_contact,
               stand.normals);
  q_.head<3>() = base_.position();
  set_base_rotation(q_, base_.rotation());
  q_.tail(robot_.nu()) = joints_.positions();
  v_.head<3>() = base_.rotation().transpose() * base_.velocity();
  v_.segment<3>(3) = base_.angular_velocity();
  v_.tail(robot_.nu()) = joints_.rates();
}

void StateEstimator::set(const Eigen::VectorXd& q, const Eigen::VectorXd& v) {
  q_ = q;
  v_ = v;
}

void StateEstimator::predict(double dt, const Eigen::VectorXd& tau, const Stand& stand, Eigen::VectorXd& q,
                             Eigen::VectorXd& v) {
  const Eigen::VectorXd a = acceleration(q, v, tau, stand);
  Eigen::VectorXd way = dt * v + 0.5 * dt * dt * a;
  way.head<3>() = base_rotation(q) * way.head<3>();
  q = integrate(q, way);
  v += dt * a;
}

Eigen::VectorXd StateEstimator::acceleration(const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                                             const Eigen::VectorXd& tau, const Stand& stand) {
  std::unique_ptr<ForwardDynamics>& dynamics = dynamics_[stand.in_contact];
  if (!dynamics) {
    std::vector<int> contacts;
    for (std::size_t c = 0; c < stand.in_contact.size(); ++c) {
      if (stand.in_contact[c]) contacts.push_back(static_cast<int>(c));
    }
    dynamics = std::make_unique<ForwardDynamics>(robot_, contacts, kContactRankThreshold);
  }
  // The estimator must survive absurd rates: their squares in the dynamics would make them grow with every sample,
  // whatever the encoders measure.
  if (!has_plausible_rates(v)) return Eigen::VectorXd::Zero(robot_.nv());
  try {
    dynamics->evaluate(q, v, tau);
    return dynamics->acceleration();
  } catch (const NumericalError&) {
    return Eigen::VectorXd::Zero(robot_.nv());
  }
}

bool StateEstimator::has_plausible_rates(const Eigen::VectorXd& v) const {
  constexpr double kBeyondLimit = 2.0;   // of the joint's own limit
  constexpr double kFastestTurn = 20.0;  // of the base [rad/s]: three turns a second
  const auto rates = v.tail(robot_.nu()).cwiseAbs().array();
  return v.allFinite() && (rates <= kBeyondLimit * robot_.velocity_limit().array()).all() &&
         v.segment<3>(3).lpNorm<Eigen::Infinity>() <= kFastestTurn;
}

}  // namespace prowl
