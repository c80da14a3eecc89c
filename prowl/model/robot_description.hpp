#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "prowl/model/limit_curve.hpp"

namespace prowl {

/// A point of the robot that may touch a surface: the centre of a ball, fixed to a frame of the URDF. It touches at one
/// radius from the surface. A flat foot has several of these points.
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
  /// Torque limit over the joint position: (position, limit), for the whole range. Empty: none.
  LimitCurve::Table torque_over_position = {};
  /// The same for negative torques alone; limits are positive. Empty: as for positive ones.
  LimitCurve::Table negative_torque_over_position = {};
  /// Limit of positive torques over the velocity: (velocity, limit). Mirrored for negative torques. Empty: none.
  LimitCurve::Table torque_over_velocity = {};
};

/// A body without moment of inertia of its own that moves with a link.
struct Payload {
  std::string body;                                  ///< link (or fixed joint) of the URDF
  double mass = 0.0;                                 ///< [kg], >= 0
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< of mass, in the frame of the link [m]
};

/// Content of a robot file, as plain data. RobotModel checks its names against the URDF.
struct RobotDescription {
  std::string name;
  std::filesystem::path urdf;  ///< absolute
  std::string urdf_text = {};  ///< its content; read from `urdf` if empty
  std::vector<ContactPoint> contacts;
  std::map<std::string, double> nominal_joints;  ///< by joint name [rad] or [m]; joints not named are at 0
  /// Held at their nominal position; RobotModel adds those that copy others.
  std::vector<std::string> locked_joints = {};
  /// By joint name: inertia of the motor as the joint feels it through the gear [kg m^2] or [kg]; others have 0.
  std::map<std::string, double> armature = {};
  Eigen::Vector3d nominal_base_rpy = Eigen::Vector3d::Zero();  ///< [rad]; x, y and height follow from the contacts
  std::map<std::string, JointLimits> limits;                   ///< by joint name
  std::vector<Payload> payloads = {};                          ///< of a task: part of mass and inertia
};

}  // namespace prowl
