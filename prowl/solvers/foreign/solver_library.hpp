#pragma once

#include <memory>
#include <string>

#include "prowl/nlp/nlp_solver.hpp"

namespace prowl {

/// A solver out of libprowl_<library>.so. `name` is that of make_solver(). Throws InputError like load_function().
std::unique_ptr<NlpSolver> load_solver(const std::string& library, const std::string& name);

}  // namespace prowl
