#pragma once

#include <memory>
#include <string>

#include "prowl/nlp/nlp_solver.hpp"

namespace prowl {

/// A solver out of libprowl_<library>.so, which is loaded at the first call and stays: Prowl starts without the
/// libraries of solvers that nobody asked for. `name` is that of make_solver(). Throws InputError with the remedy if
/// the library, or one that it needs, is not installed.
std::unique_ptr<NlpSolver> load_solver(const std::string& library, const std::string& name);

}  // namespace prowl
