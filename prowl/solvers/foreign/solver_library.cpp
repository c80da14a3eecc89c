#include "prowl/solvers/foreign/solver_library.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include "prowl/error.hpp"

namespace prowl {

std::unique_ptr<NlpSolver> load_solver(const std::string& library, const std::string& name) {
  const std::string file = fmt::format("libprowl_{}.so", library);
  void* const handle = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  void* const function = handle ? ::dlsym(handle, "prowl_make_solver") : nullptr;
  if (!function) {
    const char* const reason = ::dlerror();
    throw InputError(
        fmt::format("solver: \"{}\" is not installed: pip install \"prowl[solvers]\", in a clone scripts/setup ({})",
                    name, reason ? reason : file));
  }
  return std::unique_ptr<NlpSolver>(reinterpret_cast<NlpSolver* (*)(const char*)>(function)(name.c_str()));
}

}  // namespace prowl
