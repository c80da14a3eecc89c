#include "prowl/session/diagnose_task.hpp"

#include <fmt/format.h>

#include <utility>

#include "prowl/error.hpp"
#include "prowl/mesh/first_mesh.hpp"
#include "prowl/solvers/make_solver.hpp"

namespace prowl {

Diagnosis diagnose_task(const Task& task, DiagnosisOptions options) {
  if (!(options.max_seconds > 0.0)) {
    throw InputError(fmt::format("max_time: {} is not allowed; need a number > 0 [s]", options.max_seconds));
  }
  SolverOptions solver = task.solver;
  solver.interrupt = options.solver.interrupt;
  solver.on_iteration = std::move(options.solver.on_iteration);
  options.solver = std::move(solver);
  // What prowl plan ends with is about as fine.
  const Mesh mesh = task.has_intervals ? task.mesh : split(task.mesh, 5);
  return diagnose({task.problem, mesh}, *make_solver(solver_names().front()), *make_solver("ipopt"), options);
}

}  // namespace prowl
