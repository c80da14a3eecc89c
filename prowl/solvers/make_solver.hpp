#pragma once

#include <memory>
#include <string>
#include <vector>

#include "prowl/nlp/nlp_solver.hpp"

namespace prowl {

const std::vector<std::string>& solver_names();  ///< the first is the default

/// Throws InputError with the list of names for any other name.
std::unique_ptr<NlpSolver> make_solver(const std::string& name);

}  // namespace prowl
