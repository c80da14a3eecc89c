#include "prowl/solvers/make_solver.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "prowl/error.hpp"
#include "prowl/solvers/foreign/fatrop_solver.hpp"
#include "prowl/solvers/foreign/ipopt_solver.hpp"
#include "prowl/solvers/foreign/uno_solver.hpp"
#include "prowl/solvers/riccati/riccati_solver.hpp"

namespace prowl {

const std::vector<std::string>& solver_names() {
  static const std::vector<std::string> names = {"riccati", "fatrop", "ipopt", "ipopt-spral", "uno"};
  return names;
}

std::unique_ptr<NlpSolver> make_solver(const std::string& name) {
  if (name == "riccati") return std::make_unique<RiccatiSolver>();
  if (name == "fatrop") return std::make_unique<FatropSolver>();
  if (name == "ipopt") return std::make_unique<IpoptSolver>();
  if (name == "ipopt-spral") return std::make_unique<IpoptSolver>(IpoptLinearSolver::spral);
  if (name == "uno") return std::make_unique<UnoSolver>();
  throw InputError(fmt::format("solver: \"{}\" is not allowed; need one of {}", name, fmt::join(solver_names(), ", ")));
}

}  // namespace prowl
