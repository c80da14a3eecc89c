#pragma once

// Internal to model: see urdf_location.hpp.
#include "prowl/model/urdf/urdf_location.hpp"

namespace prowl {

/// Refuses shapes (<visual>, <collision>) of a link whose numbers are not finite, or sizes negative: urdfdom would take
/// some of them and leave others out. A shape of a kind that it does not know, or of none, is left out; meshes are not
/// looked for.
void check_shapes(const UrdfPlace& place, const tinyxml2::XMLElement& link);

}  // namespace prowl
