#include "prowl/mpc/mpc_plan.hpp"

#include <algorithm>
#include <cmath>

#include "prowl/model/configuration.hpp"
#include "prowl/model/so3.hpp"

namespace prowl {

using Eigen::VectorXd;

MpcPlan::MpcPlan(const RobotModel& robot, int steps, double most_feedback)
    : robot_(robot), most_feedback_(most_feedback), steps_(static_cast<std::size_t>(steps)) {
  const int nv = robot.nv(), nu = robot.nu();
  for (Step& step : steps_) {
    step.q = robot.nominal_configuration();
    step.v = step.a = VectorXd::Zero(nv);
    step.tau = VectorXd::Zero(nu);
    step.force = VectorXd::Zero(3 * static_cast<Eigen::Index>(robot.contacts().size()));
    step.gain = Eigen::MatrixXd::Zero(nu, 2 * nv);
  }
  q_ = robot.nominal_configuration();
  v_ = VectorXd::Zero(nv);
  deviation_ = VectorXd::Zero(2 * nv);
  feedback_ = VectorXd::Zero(nu);
}

const MpcPlan::Step& MpcPlan::step_at(double t) const {
  std::size_t k = 0;
  while (k + 1 < steps_.size() && t >= steps_[k + 1].start) ++k;
  return steps_[k];
}

void MpcPlan::state(double t, VectorXd& q, VectorXd& v) const {
  const Step& step = step_at(t);
  const double s = std::clamp(t - step.start, 0.0, 2.0 * step.length);
  v = step.v + 0.5 * s * step.a;  // mean over the time since the start
  const Eigen::Matrix3d rotation = base_rotation(step.q);
  q.head<3>() = step.q.head<3>() + s * (rotation * so3::exp(0.5 * s * v.segment<3>(3)) * v.head<3>());
  set_base_rotation(q, rotation * so3::exp(s * v.segment<3>(3)));
  q.tail(robot_.nu()) = step.q.tail(robot_.nu()) + s * v.tail(robot_.nu());
  v += 0.5 * s * step.a;
}

void MpcPlan::mean_torques(double from, double to, VectorXd& tau) const {
  tau.setZero(robot_.nu());
  double begin = from;
  for (const Step& step : steps_) {
    const double end = &step == &steps_.back() ? to : std::min(to, step.start + step.length);
    if (end <= begin) continue;
    tau += (end - begin) / (to - from) * step.tau;
    begin = end;
  }
}

void MpcPlan::torque(double t, const VectorXd& q, const VectorXd& v, VectorXd& tau) const {
  const Step& step = step_at(t);
  tau = step.tau;
  if (q.allFinite() && v.allFinite()) {
    const int nv = robot_.nv(), nu = robot_.nu();
    state(t, q_, v_);
    deviation_.head<3>() = q.head<3>() - q_.head<3>();
    deviation_.segment<3>(3) = so3::log(base_rotation(q_).transpose() * base_rotation(q));
    deviation_.segment(6, nu) = q.tail(nu) - q_.tail(nu);
    deviation_.tail(nv) = v - v_;
    feedback_.noalias() = step.gain * deviation_;
    const auto most = most_feedback_ * robot_.torque_limit();
    tau += feedback_.cwiseMin(most).cwiseMax(-most);
    if (!tau.allFinite()) tau = step.tau;
    clamp_torques(robot_, q, v, tau);
  }
  tau = tau.cwiseMin(robot_.torque_limit()).cwiseMax(-robot_.torque_limit());
}

void clamp_torques(const RobotModel& robot, const VectorXd& q, const VectorXd& v, VectorXd& tau) {
  for (int j = 0; j < robot.nu(); ++j) {
    const double position = q(7 + j), velocity = v(6 + j);
    tau(j) = std::min(robot.torque_upper(j, position, velocity),
                      std::max(robot.torque_lower(j, position, velocity), tau(j)));
  }
}

void damping_torques(const RobotModel& robot, const VectorXd& q, const VectorXd& v, VectorXd& tau) {
  constexpr double kDampedAt = 0.5;  // of the largest velocity, where damping takes the whole torque limit
  tau.setZero(robot.nu());
  if (!q.allFinite() || !v.allFinite()) return;
  for (int j = 0; j < robot.nu(); ++j) {
    const double slope = robot.torque_limit()(j) / (kDampedAt * robot.velocity_limit()(j));
    if (std::isfinite(slope)) tau(j) = -slope * v(6 + j);
  }
  clamp_torques(robot, q, v, tau);
}

}  // namespace prowl
