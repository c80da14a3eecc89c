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

/// What RobotModel needs to know of a URDF beside Pinocchio's model.
struct UrdfFacts {
  std::vector<UrdfLink> links;      ///< those that have an inertia
  std::vector<std::string> mimics;  ///< joints that copy others
};

/// Checks the text of a URDF for mistakes that its readers do not report: Pinocchio and urdfdom read the mass "1,5" as
/// 1 and "nan" as no mass, and accept a zero axis.
///
/// Throws InputError, with file, line, element, value and expected value, unless `xml` (the content of `file`) is a
/// URDF whose numbers are finite numbers, whose links form one tree, and whose moving joints are revolute or prismatic
/// with an axis and limits. RobotModel checks the values of limits and inertias. Joints in `locked` may be continuous
/// and need no limits.
UrdfFacts check_urdf(const std::string& file, const std::string& xml, const std::vector<std::string>& locked = {});

}  // namespace prowl
