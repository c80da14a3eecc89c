#pragma once

#include <Eigen/Core>
#include <vector>

namespace prowl {

/// The ground under a robot as a plane through where its contacts stood last. Nothing is allocated after construction.
class GroundPlane {
 public:
  /// `size`: of the robot [m]. Level at height 0, until contacts are seen.
  GroundPlane(int num_contacts, double size);

  /// A contact stands on the ground with its lowest point at `place`, world [m].
  void see(int contact, const Eigen::Vector3d& place);
  /// Moves the plane by a share, 0 to 1, of the way to the one that fits what was seen. A slope that collinear contacts
  /// leave undetermined is zero.
  void fit(double share);

  double height(const Eigen::Vector2d& place) const {  ///< world [m]
    return centre_.z() + slope_.dot(place - centre_.head<2>());
  }
  Eigen::Vector3d normal() const { return Eigen::Vector3d(-slope_.x(), -slope_.y(), 1.0).normalized(); }

 private:
  double size_;
  std::vector<Eigen::Vector3d> places_;
  std::vector<bool> has_place_;
  Eigen::Vector3d centre_ = Eigen::Vector3d::Zero();
  Eigen::Vector2d slope_ = Eigen::Vector2d::Zero();  ///< of the height, along x and y [-]
};

}  // namespace prowl
