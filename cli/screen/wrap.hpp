#pragma once

#include <cstddef>
#include <string>

#include "cli/screen/terminal.hpp"

namespace prowl::cli {

/// Text for a screen of so many columns: longer lines are broken at spaces, and go on below what they began with,
/// behind a label if there is one ("  solver       Riccati: ..."). A word that is longer stays whole: paths are copied.
std::string wrap(const std::string& text, std::size_t columns = cli::columns());

}  // namespace prowl::cli
