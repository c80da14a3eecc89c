#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "prowl/nlp/nlp_solver.hpp"

namespace prowl {

/// Throws InputError if an option makes no sense or the start has another size than the problem.
void check_arguments(const Nlp& nlp, const Eigen::VectorXd& z_start, const SolverOptions& options);

/// For solvers that take every program: the first variable or constraint whose bounds leave nothing.
std::optional<std::string> why_nothing_left(const Nlp& nlp);

/// For solvers that go by stages: the reason why `solver`, as the subject of a sentence, cannot take the problem.
std::optional<std::string> why_no_chain(Nlp& nlp, const std::string& solver);

}  // namespace prowl
