#include "module_files.hpp"

#include <dlfcn.h>

namespace prowl::python {

PackageSearch package_search(const std::vector<std::string>& package_dirs) {
  Dl_info module = {};
  if (::dladdr(reinterpret_cast<const void*>(&package_search), &module) == 0) return {};
  return prowl::package_search(std::filesystem::absolute(module.dli_fname).lexically_normal(), package_dirs);
}

}  // namespace prowl::python
