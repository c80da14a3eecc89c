#pragma once

#include <memory>
#include <string>
#include <vector>

#include "prowl/nlp/nlp_solver.hpp"

namespace prowl {

const std::vector<std::string>& solver_names();  ///< the first is the default

/// Throws InputError that lists the names for any other.
std::unique_ptr<NlpSolver> make_solver(const std::string& name);

}  // namespace prowl
