#include "prowl/solvers/foreign/solver_library.hpp"

#include <fmt/format.h>

#include "prowl/files/shared_library.hpp"

namespace prowl {

std::unique_ptr<NlpSolver> load_solver(const std::string& library, const std::string& name) {
  void* const function = load_function(
      "libprowl_" + library + ".so", "prowl_make_solver",
      fmt::format("solver: \"{}\" is not installed: pip install \"prowl[solvers]\", in a clone scripts/setup", name));
  return std::unique_ptr<NlpSolver>(reinterpret_cast<NlpSolver* (*)(const char*)>(function)(name.c_str()));
}

}  // namespace prowl
