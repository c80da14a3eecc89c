#pragma once

#include <string>
#include <string_view>

namespace prowl {

/// `text` made safe for a terminal: control characters, Unicode bidirectional controls and invalid
/// UTF-8 become C++ escapes. Newlines and tabs stay.
std::string printable(std::string_view text);

/// Text of a file for quoting in a message: printable(), newlines escaped, cut after kLongestShown
/// bytes.
std::string shown(std::string_view text);
constexpr std::size_t kLongestShown = 100;

}  // namespace prowl
