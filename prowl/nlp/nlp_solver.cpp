#include "prowl/nlp/nlp_solver.hpp"

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

}  // namespace prowl
