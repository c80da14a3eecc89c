#include "prowl/task_file/toml/toml_shape.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "prowl/error.hpp"

namespace prowl {
namespace {

/// Index behind the string that begins at `at`; end of the text if it is not closed.
std::size_t after_string(std::string_view text, std::size_t at) {
  const char quote = text[at];
  const bool escapes = quote == '"';
  const bool is_long = text.substr(at, 3) == std::string(3, quote);
  const std::size_t quotes = is_long ? 3 : 1;
  for (at += quotes; at < text.size(); ++at) {
    if (escapes && text[at] == '\\') {
      ++at;
    } else if (!is_long && text[at] == '\n') {
      return at;  // unclosed
    } else if (text.substr(at, quotes) == std::string(quotes, quote)) {
      at += quotes;
      for (int more = 0; is_long && more < 2 && at < text.size() && text[at] == quote; ++more)
        ++at;  // a long string may end with quotes
      return at;
    }
  }
  return text.size();
}

[[noreturn]] void refuse(const SourceText& source, std::size_t at, const char* what) {
  throw InputError(
      fmt::format("{}: {} more than {} deep are not allowed", location_in(source, at), what, kDeepestToml));
}

}  // namespace

void check_toml_shape(const SourceText& source) {
  const std::string_view text = source.text;
  int brackets = 0, dots = 0;
  for (std::size_t at = 0; at < text.size();) {
    const char c = text[at];
    if (c == '"' || c == '\'') {
      at = after_string(text, at);
      continue;
    }
    if (c == '#') {
      at = std::min(text.find('\n', at), text.size());
      continue;
    }
    if (c == '[' || c == '{') ++brackets;
    if (c == ']' || c == '}') --brackets;
    if (c == '.') ++dots;
    if (std::string_view("=,[]{}\n").find(c) != std::string_view::npos) dots = 0;
    if (brackets > kDeepestToml) refuse(source, at, "brackets");
    if (dots >= kDeepestToml) refuse(source, at, "dotted keys");
    ++at;
  }
}

}  // namespace prowl
