#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "prowl/terms/term.hpp"

namespace prowl {

/// Some entries of one quantity.
class SelectedEntries : public Term {
 public:
  /// `entries`: indices into the quantity; `rows`: their names.
  SelectedEntries(Quantity quantity, std::vector<int> entries, std::vector<std::string> rows, std::string unit)
      : Term({std::move(quantity)}, std::move(rows), std::move(unit)), entries_(std::move(entries)) {}

  const std::vector<int>& entries() const { return entries_; }

  void value(const Eigen::VectorXd& y, Eigen::Ref<Eigen::VectorXd> f) const override {
    for (std::size_t row = 0; row < entries_.size(); ++row) f(static_cast<Eigen::Index>(row)) = y(entries_[row]);
  }
  void jacobian(const Eigen::VectorXd& /*y*/, Eigen::Ref<Eigen::MatrixXd> f_y) const override {
    f_y.setZero();
    for (std::size_t row = 0; row < entries_.size(); ++row) f_y(static_cast<Eigen::Index>(row), entries_[row]) = 1.0;
  }
  void hessian(const Eigen::VectorXd& /*y*/, const Eigen::VectorXd& /*multipliers*/,
               Eigen::Ref<Eigen::MatrixXd> f_yy) const override {
    f_yy.setZero();
  }

 private:
  std::vector<int> entries_;
};

/// The three entries of a position, velocity or angular velocity, in world axes.
inline std::shared_ptr<const Term> world_vector(Quantity quantity, std::string unit) {
  return std::make_shared<SelectedEntries>(std::move(quantity), std::vector<int>{0, 1, 2},
                                           std::vector<std::string>{"x", "y", "z"}, std::move(unit));
}

/// Centre of mass of the robot [m], world axes.
inline std::shared_ptr<const Term> center_of_mass() {
  return world_vector({.kind = Quantity::Kind::center_of_mass}, "m");
}

/// Its velocity [m/s], world axes.
inline std::shared_ptr<const Term> center_of_mass_velocity() {
  return world_vector({.kind = Quantity::Kind::center_of_mass_velocity}, "m/s");
}

/// Angular momentum of the robot about its centre of mass [N m s], world axes.
inline std::shared_ptr<const Term> angular_momentum() {
  return world_vector({.kind = Quantity::Kind::angular_momentum}, "N m s");
}

/// Force of the ground on a contact [N], world axes; zero while the contact is open.
inline std::shared_ptr<const Term> contact_force(const std::string& contact) {
  return world_vector({.kind = Quantity::Kind::force, .name = contact}, "N");
}

/// Positions of some joints [rad], their rates [rad/s], or the torques on their links [N m]; `joints`: indices,
/// 0 ... nu - 1, none of them sliding.
std::shared_ptr<const Term> joint_positions(const RobotModel& robot, const std::vector<int>& joints);
std::shared_ptr<const Term> joint_rates(const RobotModel& robot, const std::vector<int>& joints);
std::shared_ptr<const Term> joint_torques(const RobotModel& robot, const std::vector<int>& joints);

}  // namespace prowl
