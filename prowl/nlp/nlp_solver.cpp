#include "prowl/nlp/nlp_solver.hpp"

#include <fmt/format.h>

#include "prowl/error.hpp"

namespace prowl {

const char* to_string(SolveStatus status) {
  switch (status) {
    case SolveStatus::converged: return "converged";
    case SolveStatus::infeasible: return "infeasible";
    case SolveStatus::iteration_limit: return "iteration_limit";
    case SolveStatus::time_limit: return "time_limit";
    case SolveStatus::interrupted: return "interrupted";
    case SolveStatus::evaluation_failed: return "evaluation_failed";
    case SolveStatus::solver_failed: return "solver_failed";
  }
  return "unknown";
}

void validate(const SolverOptions& options) {
  if (!(options.tolerance > 0.0 && options.tolerance < 1.0)) {
    throw InputError(fmt::format("solver tolerance {} is not allowed; need 0 < tolerance < 1", options.tolerance));
  }
  if (options.max_iterations < 0) {
    throw InputError(fmt::format("max_iterations {} is not allowed; need 0 or more", options.max_iterations));
  }
  if (options.threads < 1) throw InputError(fmt::format("{} threads are not allowed; need 1 or more", options.threads));
  if (!(options.max_seconds > 0.0)) {
    throw InputError(fmt::format("max_seconds {} is not allowed; need more than 0 [s]", options.max_seconds));
  }
}

SolveTimes& SolveTimes::operator+=(const SolveTimes& other) {
  cpu += other.cpu;
  values += other.values;
  derivatives += other.derivatives;
  linear_algebra += other.linear_algebra;
  guess += other.guess;
  return *this;
}

}  // namespace prowl
