#include "prowl/text/name_check.hpp"

#include <algorithm>

namespace prowl {

namespace {

constexpr std::size_t kLongestName = 200;  // used in file names and columns

}  // namespace

const char* const kNameRule = "at most 200 printable ASCII characters without , \" ' and \\, no space at either end";

bool is_name(const std::string& name) {
  if (name.empty() || name.size() > kLongestName || name.front() == ' ' || name.back() == ' ') return false;
  return std::all_of(name.begin(), name.end(),
                     [](char c) { return c >= ' ' && c <= '~' && c != ',' && c != '"' && c != '\'' && c != '\\'; });
}

}  // namespace prowl
