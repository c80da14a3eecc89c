#pragma once

#include <string>
#include <vector>

#include "prowl/session/environment.hpp"

namespace prowl::python {

/// Folders to search for package://, these first (session/environment.hpp).
PackageSearch package_search(const std::vector<std::string>& package_dirs);

}  // namespace prowl::python
