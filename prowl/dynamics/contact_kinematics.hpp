#pragma once

#include <utility>
#include <vector>

#include "prowl/dynamics/point_kinematics.hpp"

namespace prowl {

/// Kinematics of contacts of the robot.
class ContactKinematics : private PointKinematics {
 public:
  /// `contacts`: indices of contacts of the robot, in the order of the rows.
  explicit ContactKinematics(std::vector<int> contacts)
      : PointKinematics(std::vector<BodyPoint>(contacts.size())), contacts_(std::move(contacts)) {}

  const std::vector<int>& contacts() const { return contacts_; }

  /// Takes the configuration at which `terms` was updated last.
  void set_configuration(const RigidBodyTerms& terms) {
    for (std::size_t c = 0; c < contacts_.size(); ++c) points_[c] = terms.contact_point(contacts_[c]);
    PointKinematics::set_configuration(terms);
  }

  using PointKinematics::acceleration;
  using PointKinematics::acceleration_dq;
  using PointKinematics::acceleration_dv;
  using PointKinematics::add_acceleration_hessian;
  using PointKinematics::add_acceleration_hessian_qq;
  using PointKinematics::add_force_derivative;
  using PointKinematics::add_position_hessian;
  using PointKinematics::jacobian;
  using PointKinematics::positions;
  using PointKinematics::positions_dq;
  using PointKinematics::rows;
  using PointKinematics::set_motion;

 private:
  std::vector<int> contacts_;
};

}  // namespace prowl
