#pragma once

#include <string>

namespace prowl::cli {

/// The text with colours for a terminal: verdicts at the end of table rows and after "certificate:"
/// green, yellow or red; "note:" and "warning:" yellow; "prowl:" of errors red; headings of help
/// bold. Adds only escape codes.
std::string paint(const std::string& text);

}  // namespace prowl::cli
