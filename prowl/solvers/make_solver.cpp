#include "prowl/solvers/make_solver.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "prowl/error.hpp"
#include "prowl/solvers/foreign/solver_library.hpp"
#include "prowl/solvers/riccati/riccati_solver.hpp"

namespace prowl {

const std::vector<std::string>& solver_names() {
  static const std::vector<std::string> names = {"riccati", "fatrop", "ipopt", "ipopt-spral", "uno"};
  return names;
}

std::unique_ptr<NlpSolver> make_solver(const std::string& name) {
  if (name == "riccati") return std::make_unique<RiccatiSolver>();
  if (name == "fatrop" || name == "uno") return load_solver(name, name);
  if (name == "ipopt" || name == "ipopt-spral") return load_solver("ipopt", name);
  throw InputError(fmt::format("solver: \"{}\" is not allowed; need one of {}", name, fmt::join(solver_names(), ", ")));
}

std::unique_ptr<NlpSolver> make_solver_if_installed(const std::string& name) {
  try {
    return make_solver(name);
  } catch (const InputError&) {
    return nullptr;
  }
}

}  // namespace prowl
