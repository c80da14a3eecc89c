#pragma once

#include <Eigen/Core>
#include <string>

#include "prowl/model/robot_model.hpp"

namespace prowl {

/// What bounds of the torques of a plan leave of a constant torque limit for the losses of the joint [N m]: those at
/// its largest rate, if they are small; else infinite.
double room_for_losses(const RobotModel& robot, int joint);

/// Torque limits that depend on the state, at one node: two rows >= 0 for each curve of the robot,
///   over the position   positive(q) - motor,   negative(q) + motor
///   over the velocity   positive(v) - motor,   negative(-v) + motor
/// (Pardo et al. 2016 print one side), divided by the largest torque of its tables. motor = tau + loss(v). The constant
/// limit of a joint is such a curve, too, if room_for_losses() is infinite.
class TorqueRows {
 public:
  using Vector = Eigen::Ref<const Eigen::VectorXd>;

  explicit TorqueRows(const RobotModel& robot);

  int count() const { return 2 * static_cast<int>(curves_.size()); }
  std::string describe(int row) const;
  int joint(int row) const { return curves_[row / 2].joint; }
  double largest(int row) const { return 1.0 / scale_(row / 2); }  ///< largest torque of the curve's tables [N m]

  /// joints, rates, tau: nu each; values: count().
  void evaluate(const Vector& joints, const Vector& rates, const Vector& tau, Eigen::Ref<Eigen::VectorXd> values) const;
  /// Derivatives in (joints, rates, tau); overwrites all entries.
  void derivatives(const Vector& joints, const Vector& rates, Eigen::Ref<Eigen::MatrixXd> d_joints,
                   Eigen::Ref<Eigen::MatrixXd> d_rates, Eigen::Ref<Eigen::MatrixXd> d_tau) const;
  /// Adds the second derivatives of multipliers . rows, which are diagonal.
  void add_hessian(const Vector& joints, const Vector& rates, const Vector& multipliers,
                   Eigen::Ref<Eigen::VectorXd> joints_diagonal, Eigen::Ref<Eigen::VectorXd> rates_diagonal) const;

 private:
  /// Argument of a curve in its row 0 or 1.
  static double argument(const RobotModel::TorqueCurve& limit, int side, const Vector& joints, const Vector& rates) {
    return limit.over_velocity ? (side == 0 ? rates(limit.joint) : -rates(limit.joint)) : joints(limit.joint);
  }

  static const LimitCurve& side(const RobotModel::TorqueCurve& limit, int side) {
    return side == 0 ? limit.positive : limit.negative;
  }

  std::vector<RobotModel::TorqueCurve> curves_;
  JointLosses losses_;
  std::vector<std::string> names_;
  Eigen::VectorXd scale_;  ///< one a curve
};

}  // namespace prowl
