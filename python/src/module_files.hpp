#pragma once

#include <string>
#include <vector>

#include "prowl/session/environment.hpp"

namespace prowl::python {

/// Where this module looks for package://, these folders first (session/environment.hpp).
PackageSearch package_search(const std::vector<std::string>& package_dirs);

}  // namespace prowl::python
