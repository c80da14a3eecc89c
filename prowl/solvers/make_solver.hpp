#pragma once

#include <memory>
#include <string>
#include <vector>

#include "prowl/nlp/nlp_solver.hpp"

namespace prowl {

const std::vector<std::string>& solver_names();  ///< the first is the default

/// Throws InputError with the list of names for any other name, and with the remedy if the solver is not installed.
std::unique_ptr<NlpSolver> make_solver(const std::string& name);

/// The same; nullptr instead of an exception.
std::unique_ptr<NlpSolver> make_solver_if_installed(const std::string& name);

}  // namespace prowl
