#include "prowl/files/shared_library.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include "prowl/error.hpp"

namespace prowl {

void* load_function(const std::filesystem::path& library, const char* function, const std::string& remedy) {
  void* const handle = ::dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
  void* const address = handle ? ::dlsym(handle, function) : nullptr;
  if (address) return address;
  const char* const reason = ::dlerror();
  throw InputError(fmt::format("{} ({})", remedy, reason ? reason : library.string()));
}

}  // namespace prowl
