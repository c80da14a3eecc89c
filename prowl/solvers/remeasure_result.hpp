#pragma once

#include <string>

#include "prowl/nlp/nlp_solver.hpp"

namespace prowl {

/// Recomputes cost and constraint violation at result.z. A converged result that is not within
/// tolerance becomes solver_failed, one that cannot be evaluated evaluation_failed.
void remeasure_result(Nlp& nlp, double tolerance, const std::string& solver, SolveResult& result);

}  // namespace prowl
