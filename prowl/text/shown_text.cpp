#include "prowl/text/shown_text.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace prowl {
namespace {

/// A UTF-8 character; size 0 for invalid bytes.
struct Character {
  char32_t code = 0;
  std::size_t size = 0;
};

Character first_of(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char lead = byte(0);
  if (lead < 0x80) return {lead, 1};
  const std::size_t size = lead >= 0xf0 && lead < 0xf5 ? 4 : lead >= 0xe0 ? 3 : lead >= 0xc2 ? 2 : 0;
  if (size == 0 || lead >= 0xf5 || size > text.size()) return {};
  char32_t code = lead & (0xffu >> (size + 1));
  for (std::size_t i = 1; i < size; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return {};
    code = (code << 6) | (byte(i) & 0x3fu);
  }
  constexpr char32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};  // overlong forms are invalid
  if (code < kLeast[size] || code > 0x10ffff || (code >= 0xd800 && code < 0xe000)) return {};
  return {code, size};
}

/// C0 except tab and newline, DEL, C1; bidirectional marks, embeddings, overrides and isolates;
/// line separators.
bool is_control(char32_t c) {
  return (c < 0x20 && c != '\n' && c != '\t') || (c >= 0x7f && c < 0xa0) || c == 0x200e || c == 0x200f ||
         (c >= 0x2028 && c <= 0x202e) || (c >= 0x2066 && c <= 0x2069);
}

}  // namespace

std::string printable(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  while (!text.empty()) {
    const Character c = first_of(text);
    if (c.size == 0) {
      result += fmt::format("\\x{:02x}", static_cast<unsigned char>(text[0]));
    } else if (is_control(c.code)) {
      result += c.code < 0x100 ? fmt::format("\\x{:02x}", static_cast<unsigned>(c.code))
                               : fmt::format("\\u{:04x}", static_cast<unsigned>(c.code));
    } else {
      result += text.substr(0, c.size);
    }
    text.remove_prefix(c.size == 0 ? 1 : c.size);
  }
  return result;
}

std::string shown(std::string_view text) {
  std::size_t end = std::min(text.size(), kLongestShown);
  while (end > 0 && end < text.size() && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) --end;
  std::string result;
  for (const char c : printable(text.substr(0, end))) c == '\n' ? result += "\\n" : result += c;
  return end == text.size() ? result : fmt::format("{}... ({} bytes)", result, text.size());
}

}  // namespace prowl
