#include "prowl/transcription/node/torque_rows.hpp"

#include <algorithm>

namespace prowl {

TorqueRows::TorqueRows(const RobotModel& robot) : curves_(robot.torque_curves()) {
  scale_.resize(static_cast<Eigen::Index>(curves_.size()));
  for (std::size_t c = 0; c < curves_.size(); ++c) {
    const std::string& joint = robot.joint_names()[curves_[c].joint];
    names_.push_back("torque of " + joint + " over its " + (curves_[c].over_velocity ? "velocity" : "position"));
    scale_(static_cast<Eigen::Index>(c)) = 1.0 / curves_[c].curve.largest();
  }
}

std::string TorqueRows::describe(int row) const {
  return names_[row / 2] + (row % 2 == 0 ? ", upper limit" : ", lower limit");
}

void TorqueRows::evaluate(const Vector& joints, const Vector& rates, const Vector& tau,
                          Eigen::Ref<Eigen::VectorXd> values) const {
  for (int row = 0; row < count(); ++row) {
    const RobotModel::TorqueCurve& limit = curves_[row / 2];
    const double phi = limit.curve.value(argument(limit, row % 2, joints, rates));
    values(row) = scale_(row / 2) * (row % 2 == 0 ? phi - tau(limit.joint) : phi + tau(limit.joint));
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
    const double slope = scale * limit.curve.slope(argument(limit, row % 2, joints, rates));
    if (limit.over_velocity) {
      d_rates(row, limit.joint) = sign * slope;
    } else {
      d_joints(row, limit.joint) = slope;
    }
    d_tau(row, limit.joint) = -sign * scale;
  }
}

void TorqueRows::add_hessian(const Vector& joints, const Vector& rates, const Vector& multipliers,
                             Eigen::Ref<Eigen::VectorXd> joints_diagonal,
                             Eigen::Ref<Eigen::VectorXd> rates_diagonal) const {
  for (int row = 0; row < count(); ++row) {
    const RobotModel::TorqueCurve& limit = curves_[row / 2];
    const double curvature = limit.curve.curvature(argument(limit, row % 2, joints, rates));
    (limit.over_velocity ? rates_diagonal : joints_diagonal)(limit.joint) +=
        multipliers(row) * scale_(row / 2) * curvature;
  }
}

}  // namespace prowl
