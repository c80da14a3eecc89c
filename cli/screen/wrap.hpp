#pragma once

#include <cstddef>
#include <string>

#include "cli/screen/terminal.hpp"

namespace prowl::cli {

/// Breaks long lines at spaces, with a hanging indent, behind a label if there is one ("  solver
/// Riccati: ..."). Longer words stay whole: users copy paths.
std::string wrap(const std::string& text, std::size_t columns = cli::columns());

}  // namespace prowl::cli
