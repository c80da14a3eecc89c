#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "prowl/model/robot_model.hpp"

namespace prowl {

/// A link of the URDF, fixed to one of the bodies that joints move.
struct LinkFrame {
  std::string name;
  int body = 0;                                                  ///< index into BodyTree::bodies
  Eigen::Isometry3d placement = Eigen::Isometry3d::Identity();  ///< of the link in the body
};

/// All links of the robot, parents first.
std::vector<LinkFrame> link_frames(const RobotModel& robot);

}  // namespace prowl
