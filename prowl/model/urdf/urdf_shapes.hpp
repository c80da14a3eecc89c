#pragma once

// Internal to model: see urdf_location.hpp.
#include "prowl/model/urdf/urdf_location.hpp"

namespace prowl {

/// Refuses shapes (<visual>, <collision>) of a link with numbers that are not finite or negative sizes: urdfdom would
/// accept some of them and drop others. Ignores shapes of an unknown kind or none; does not look for mesh files.
void check_shapes(const UrdfLocation& location, const tinyxml2::XMLElement& link);

}  // namespace prowl
