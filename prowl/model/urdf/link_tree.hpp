#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "prowl/model/robot_model.hpp"

namespace prowl {

/// A link of the URDF. Links joined by fixed joints are one body of BodyTree, but each has its own frame.
struct RobotLink {
  std::string name;
  int parent = -1;                                              ///< index of its parent link; -1 for the root
  bool fixed = false;                                           ///< to its parent; the root is not
  int body = 0;                                                 ///< index into BodyTree::bodies
  Eigen::Isometry3d placement = Eigen::Isometry3d::Identity();  ///< in the body
};

/// The root first, parents before children.
std::vector<RobotLink> link_tree(const RobotModel& robot);

/// Placements of the links in the world, from those of the bodies (BodyPlacements).
std::vector<Eigen::Isometry3d> link_placements(const std::vector<RobotLink>& links,
                                               const std::vector<Eigen::Isometry3d>& bodies);

}  // namespace prowl
