#pragma once

#include <Eigen/Geometry>
#include <string>

#include "prowl/model/robot_model.hpp"

namespace prowl {

/// Where a link of the URDF sits on the body that moves it.
struct RobotFrame {
  int body = 0;                                                 ///< index into BodyTree::bodies
  Eigen::Isometry3d placement = Eigen::Isometry3d::Identity();  ///< in the body
};

/// The floating base, unless a link has this name.
inline constexpr const char* kBaseFrame = "base";

/// The frame of a link, or of the base by the name "base". Throws InputError that names the nearest link.
RobotFrame robot_frame(const RobotModel& robot, const std::string& name);

}  // namespace prowl
