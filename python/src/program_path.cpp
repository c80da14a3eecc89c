#include "program_path.hpp"

#include <dlfcn.h>

namespace prowl::cli {

std::filesystem::path program_path() {
  Dl_info module = {};
  if (::dladdr(reinterpret_cast<const void*>(&program_path), &module) == 0) return {};
  return std::filesystem::absolute(module.dli_fname).lexically_normal();
}

}  // namespace prowl::cli
