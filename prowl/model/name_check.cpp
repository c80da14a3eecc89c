#include "prowl/model/name_check.hpp"

#include <algorithm>

namespace prowl {

const char* const kNameRule = "printable ASCII characters without , \" ' and \\, no space at either end";

bool is_name(const std::string& name) {
  if (name.empty() || name.front() == ' ' || name.back() == ' ') return false;
  return std::all_of(name.begin(), name.end(),
                     [](char c) { return c >= ' ' && c <= '~' && c != ',' && c != '"' && c != '\'' && c != '\\'; });
}

}  // namespace prowl
