#pragma once

#include <string>

namespace prowl::cli {

/// The text with colours for a terminal: verdicts at the end of a row of a table and behind "certificate:" green,
/// yellow or red, "note:" and "warning:" yellow, "prowl:" of an error red, headings of help bold. Nothing but escape
/// codes is added, so that without them the text is the same.
std::string paint(const std::string& text);

}  // namespace prowl::cli
