#include "prowl/model/urdf/urdf_outline.hpp"

#include <urdf_parser/urdf_parser.h>

#include "prowl/error.hpp"
#include "prowl/model/urdf/urdf_check.hpp"

namespace prowl {

UrdfOutline urdf_outline(const std::string& file, const std::string& xml) {
  check_urdf(file, xml);
  const urdf::ModelInterfaceSharedPtr urdf = urdf::parseURDF(xml);
  if (!urdf) throw InputError(file + ": urdfdom cannot read it");
  UrdfOutline outline;
  outline.name = urdf->getName();
  for (const auto& [name, joint] : urdf->joints_) {
    if (joint->type == urdf::Joint::FIXED || joint->mimic || !joint->limits) continue;
    const urdf::JointLimits& limits = *joint->limits;
    outline.joints.push_back(
        {name, joint->type == urdf::Joint::PRISMATIC, limits.lower, limits.upper, limits.velocity, limits.effort});
  }
  return outline;
}

}  // namespace prowl
