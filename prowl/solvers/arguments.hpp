#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "prowl/nlp/nlp_solver.hpp"

namespace prowl {

/// Throws InputError for an invalid option or a start of the wrong size.
void check_arguments(const Nlp& nlp, const Eigen::VectorXd& z_guess, const SolverOptions& options);

/// For solvers of general programs: the first variable or constraint with empty bounds; nullopt if
/// none.
std::optional<std::string> why_nothing_left(const Nlp& nlp);

/// For stage-wise solvers: why `solver` (subject of the sentence) cannot solve the problem; nullopt
/// if it can.
std::optional<std::string> why_no_chain(Nlp& nlp, const std::string& solver);

}  // namespace prowl
