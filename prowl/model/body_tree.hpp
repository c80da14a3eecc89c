#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "prowl/model/robot_model.hpp"

namespace prowl {

/// A rigid body of the robot (links joined by fixed joints are one) and the joint that moves it, as plain data for
/// programs that rebuild the robot by other means.
struct RigidBody {
  std::string name;                                             ///< of its joint; "base" for the first
  int parent = -1;                                              ///< index into BodyTree::bodies; -1 for the base
  Eigen::Isometry3d placement = Eigen::Isometry3d::Identity();  ///< of the body in its parent with the joint at 0
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();              ///< of the joint, through the body's origin, body axes
  bool prismatic = false;
  double mass = 0.0;                                  ///< [kg]
  Eigen::Vector3d center = Eigen::Vector3d::Zero();   ///< of mass, in the body [m]
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< about the centre of mass, body axes [kg m^2]
};

struct BodyTree {
  /// A point that may touch, fixed to a body.
  struct Point {
    int body = 0;
    Eigen::Vector3d position;  ///< in the body [m]
  };
  std::vector<RigidBody> bodies;  ///< the base, then one for each joint of the robot, in its order; parents first
  std::vector<Point> points;      ///< one for each contact of the robot, in its order
};

BodyTree body_tree(const RobotModel& robot);

}  // namespace prowl
