#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "prowl/refine.hpp"

namespace prowl::cli {

/// --refine: draft (without value), certified, or a re-integration error. Nullopt if absent.
void add_refine(CLI::App& verb, std::optional<MeshTolerance>& tolerance);

/// One line per mesh: "66 intervals, 15 iterations: re-integration 7.1e-04 of 5.0e-04, local error
/// ...".
std::string in_words(const RefineRound& round, const MeshTolerance& tolerance);

}  // namespace prowl::cli
