#pragma once

#include <map>
#include <string>

#include "prowl/model/urdf/package_path.hpp"

namespace prowl {

/// URDFs of example-robot-data by name: "b1" ->
/// "package://example-robot-data/robots/b1_description/urdf/b1.urdf". Empty if it is not installed.
std::map<std::string, std::string> packaged_robots(const PackageSearch& search);

/// "; did you mean package://.../b1.urdf? Packaged robots: a1, ..." for the end of a message; the
/// name in `wrong`, a path, decides. "" without packaged robots.
std::string nearest_packaged_robot(const std::string& wrong, const PackageSearch& search);

}  // namespace prowl
