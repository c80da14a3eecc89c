#pragma once

#include <string>
#include <vector>

namespace prowl {

/// Joints of a URDF that move by themselves, before RobotModel checks them.
struct UrdfOutline {
  /// As written; missing numbers are 0.
  struct Limits {
    std::string joint;
    bool prismatic = false;
    double lower = 0.0, upper = 0.0;  ///< [rad] or [m]
    double velocity = 0.0;            ///< [rad/s] or [m/s]
    double effort = 0.0;              ///< [N m] or [N]

    bool has_range() const { return lower < upper; }
  };
  std::string name;  ///< of the robot
  std::vector<Limits> joints;
};

/// Throws InputError as check_urdf (prowl/model/urdf/urdf_check.hpp) does; `xml` is the content of `file`.
UrdfOutline urdf_outline(const std::string& file, const std::string& xml);

}  // namespace prowl
