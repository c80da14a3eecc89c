#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "prowl/nlp/nlp_solver.hpp"

namespace prowl {

/// Throws InputError if an option makes no sense or the start has another size than the problem.
void check_arguments(const Nlp& nlp, const Eigen::VectorXd& z_start, const SolverOptions& options);

/// The first variable or constraint, in words, whose bounds leave nothing; if there is one, no solver can take the problem.
std::optional<std::string> why_empty(const Nlp& nlp);

/// For solvers that go by stages: the reason why `solver`, as the subject of a sentence, cannot take the problem.
std::optional<std::string> why_no_chain(Nlp& nlp, const std::string& solver);

}  // namespace prowl
