#pragma once

#include <string>
#include <vector>

#include "prowl/session/environment.hpp"

namespace prowl::python {

using Folders = std::vector<std::string>;

/// Folders to search for package://, these first (session/environment.hpp).
PackageSearch package_search(const Folders& package_dirs);

}  // namespace prowl::python
