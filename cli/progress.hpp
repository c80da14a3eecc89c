#pragma once

#include <functional>

#include "prowl/nlp/nlp_solver.hpp"

namespace prowl::cli {

/// Writes one line an iteration to stderr, under a heading that comes again every 20 lines in a terminal. Plain text, so
/// that it reads the same when piped.
std::function<void(const SolveProgress&)> progress_printer();

}  // namespace prowl::cli
