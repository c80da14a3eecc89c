#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace prowl {

/// A link of the file that has an <inertial>, as written there.
struct UrdfLink {
  std::string name;
  double mass = 0.0;        ///< [kg]
  Eigen::Matrix3d inertia;  ///< about its centre of mass, in the axes of its <origin> [kg m^2]
};

/// Refuses what URDF readers let pass or stumble over, by the text of the file itself: Pinocchio and urdfdom read the
/// mass "1,5" as 1 and "nan" as no mass, drop mimic joints and take a zero axis, all without a word.
///
/// Throws InputError, with file, line, element, value and what is expected, unless `xml` (the content of `file`) is a
/// URDF whose numbers are finite numbers, whose links form one tree, and whose moving joints are revolute or prismatic
/// with an axis and limits. Whether limits and inertias make sense is judged later, by RobotModel.
/// Returns the links that have an inertia.
std::vector<UrdfLink> check_urdf(const std::string& file, const std::string& xml);

}  // namespace prowl
