#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "prowl/model/limit_curve.hpp"

namespace prowl {

/// A place on the robot that may touch a surface: a point fixed to a frame of the URDF, at the centre of a ball of the
/// given radius, so that it touches when the point is one radius away from the surface. Flat feet are several of them.
struct ContactPoint {
  std::string name;                                  ///< unique in the robot
  std::string frame;                                 ///< a frame (link or fixed joint) of the URDF
  double radius = 0.0;                               ///< [m], >= 0
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< of the point from the frame's origin, in the frame [m]
};

/// Limits of one joint that replace those of the URDF where given.
struct JointLimits {
  std::optional<double> position_lower;  ///< [rad] or [m]
  std::optional<double> position_upper;  ///< [rad] or [m]
  std::optional<double> velocity;        ///< [rad/s] or [m/s], symmetric
  std::optional<double> torque;          ///< [N m] or [N], symmetric
  /// Torque limit over the joint position, both ways: (position, limit), over all of the joint's range. Empty: none.
  LimitCurve::Table torque_over_position = {};
  /// Limit of the torque in the direction of positive velocity: (velocity, limit). Mirrored for the other. Empty: none.
  LimitCurve::Table torque_over_velocity = {};
};

/// What a robot file says, as plain data. Names are not yet checked against the URDF: RobotModel does that.
struct RobotDescription {
  std::string name;
  std::filesystem::path urdf;  ///< absolute
  std::string urdf_text = {};  ///< what is in it; read from there if empty
  std::vector<ContactPoint> contacts;
  std::map<std::string, double> nominal_joints;  ///< by joint name [rad] or [m]; joints not named are at 0
  Eigen::Vector3d nominal_base_rpy = Eigen::Vector3d::Zero();  ///< [rad]; x, y and height follow from the contacts
  std::map<std::string, JointLimits> limits;                   ///< by joint name
};

}  // namespace prowl
