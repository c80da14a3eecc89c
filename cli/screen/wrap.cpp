#include "cli/screen/wrap.hpp"

#include <algorithm>
#include <sstream>

namespace prowl::cli {
namespace {

/// Indent of continuation lines.
std::size_t hanging_indent(const std::string& line) {
  constexpr std::size_t kLongestLabel = 16;
  const std::size_t first = line.find_first_not_of(' ');
  const std::size_t gap = line.find("  ", first);
  const std::size_t behind = gap == std::string::npos ? gap : line.find_first_not_of(' ', gap);
  return behind < kLongestLabel ? behind : first + 2;
}

}  // namespace

std::string wrap(const std::string& text, std::size_t columns) {
  std::istringstream lines(text);
  std::string wrapped;
  for (std::string line; std::getline(lines, line);) {
    const std::size_t indent = line.size() > columns ? hanging_indent(line) : 0;
    while (line.size() > columns) {
      std::size_t end = line.rfind(' ', columns);
      const std::size_t next = end == std::string::npos ? end : line.find(' ', end + 1);
      const bool fits = std::min(next, line.size()) - end - 1 <= columns - indent;  // the next word alone on a line
      if (end == std::string::npos || end <= indent || !fits) end = line.find(' ', columns);
      if (end == std::string::npos) break;
      wrapped += line.substr(0, end) + "\n";
      line = std::string(indent, ' ') + line.substr(line.find_first_not_of(' ', end));
    }
    wrapped += line + "\n";
  }
  return wrapped;
}

}  // namespace prowl::cli
