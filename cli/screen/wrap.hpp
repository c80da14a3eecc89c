#pragma once

#include <string>

namespace prowl::cli {

/// Text for a screen of 80 columns: longer lines are broken at spaces, and go on below what they began with, behind a
/// label if there is one ("  solver       Riccati: ..."). A word that is longer stays whole: paths are copied.
std::string wrap(const std::string& text);

}  // namespace prowl::cli
