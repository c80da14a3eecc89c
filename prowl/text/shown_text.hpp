#pragma once

#include <string>
#include <string_view>

namespace prowl {

/// `text` as it is fit for a terminal: control characters, marks that turn text round (Unicode bidirectional controls)
/// and bytes that are not UTF-8 as escapes, as in a string of C++. Ends of lines and tabs stay.
std::string printable(std::string_view text);

/// What a file says, to be quoted in a message: printable, ends of lines as escapes too, cut after kLongestShown bytes.
std::string shown(std::string_view text);
constexpr std::size_t kLongestShown = 100;

}  // namespace prowl
