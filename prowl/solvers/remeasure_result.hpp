#pragma once

#include <string>

#include "prowl/nlp/nlp_solver.hpp"

namespace prowl {

/// Cost and constraint violation of result.z from the point itself, whatever the solver says of it. A result that
/// claims to have converged and is not within tolerance becomes solver_failed, one that cannot be evaluated
/// evaluation_failed.
void remeasure_result(Nlp& nlp, double tolerance, const std::string& solver, SolveResult& result);

}  // namespace prowl
