#include "prowl/transcription/node/torque_rows.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace prowl {

double room_for_losses(const RobotModel& robot, int joint) {
  constexpr double kSmall = 0.05;  // of the limit; rows take time
  if (!robot.losses().of(joint)) return 0.0;
  const double fastest = robot.velocity_limit()(joint), limit = robot.torque_limit()(joint);
  const double most = std::isfinite(fastest) ? robot.losses().torque(joint, fastest) : fastest;
  return most <= kSmall * limit ? most : std::numeric_limits<double>::infinity();
}

TorqueRows::TorqueRows(const RobotModel& robot) : curves_(robot.torque_curves()), losses_(robot.losses()) {
  for (std::size_t c = 0; c < curves_.size(); ++c) {
    names_.push_back("torque of " + robot.joint_names()[curves_[c].joint] + " over its " +
                     (curves_[c].over_velocity ? "velocity" : "position"));
  }
  for (int j = 0; j < robot.nu(); ++j) {
    const double most = robot.torque_limit()(j);
    if (!std::isfinite(most) || std::isfinite(room_for_losses(robot, j))) continue;
    const LimitCurve constant({{-1.0, most}, {-0.5, most}, {0.5, most}, {1.0, most}});
    curves_.push_back({j, true, constant, constant});
    names_.push_back("torque of " + robot.joint_names()[j]);
  }
  scale_.resize(static_cast<Eigen::Index>(curves_.size()));
  for (std::size_t c = 0; c < curves_.size(); ++c) {
    scale_(static_cast<Eigen::Index>(c)) = 1.0 / std::max(curves_[c].positive.largest(), curves_[c].negative.largest());
  }
}

std::string TorqueRows::describe(int row) const {
  return names_[row / 2] + (row % 2 == 0 ? ", upper limit" : ", lower limit");
}

void TorqueRows::evaluate(const Vector& joints, const Vector& rates, const Vector& tau,
                          Eigen::Ref<Eigen::VectorXd> values) const {
  for (int row = 0; row < count(); ++row) {
    const RobotModel::TorqueCurve& limit = curves_[row / 2];
    const double phi = side(limit, row % 2).value(argument(limit, row % 2, joints, rates));
    const double motor = tau(limit.joint) + losses_.torque(limit.joint, rates(limit.joint));
    values(row) = scale_(row / 2) * (row % 2 == 0 ? phi - motor : phi + motor);
  }
}

void TorqueRows::derivatives(const Vector& joints, const Vector& rates, Eigen::Ref<Eigen::MatrixXd> d_joints,
                             Eigen::Ref<Eigen::MatrixXd> d_rates, Eigen::Ref<Eigen::MatrixXd> d_tau) const {
  d_joints.setZero();
  d_rates.setZero();
  d_tau.setZero();
  for (int row = 0; row < count(); ++row) {
    const RobotModel::TorqueCurve& limit = curves_[row / 2];
    const double scale = scale_(row / 2), sign = row % 2 == 0 ? 1.0 : -1.0;
    const double slope = scale * side(limit, row % 2).slope(argument(limit, row % 2, joints, rates));
    if (limit.over_velocity) {
      d_rates(row, limit.joint) = sign * slope;
    } else {
      d_joints(row, limit.joint) = slope;
    }
    d_rates(row, limit.joint) -= sign * scale * losses_.slope(limit.joint, rates(limit.joint));
    d_tau(row, limit.joint) = -sign * scale;
  }
}

void TorqueRows::add_hessian(const Vector& joints, const Vector& rates, const Vector& multipliers,
                             Eigen::Ref<Eigen::VectorXd> joints_diagonal,
                             Eigen::Ref<Eigen::VectorXd> rates_diagonal) const {
  for (int row = 0; row < count(); ++row) {
    const RobotModel::TorqueCurve& limit = curves_[row / 2];
    const double curvature = side(limit, row % 2).curvature(argument(limit, row % 2, joints, rates));
    (limit.over_velocity ? rates_diagonal : joints_diagonal)(limit.joint) +=
        multipliers(row) * scale_(row / 2) * curvature;
    const double bend = losses_.curvature(limit.joint, rates(limit.joint));
    rates_diagonal(limit.joint) -= (row % 2 == 0 ? 1.0 : -1.0) * multipliers(row) * scale_(row / 2) * bend;
  }
}

}  // namespace prowl
