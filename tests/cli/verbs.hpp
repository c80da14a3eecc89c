#pragma once

#include <sstream>
#include <string>
#include <vector>

namespace prowl::test {

/// All verbs, as `prowl --help` has them, so that none is forgotten.
inline std::vector<std::string> verbs(const std::string& help) {
  const std::string heading = "Subcommands:\n";
  std::istringstream lines(help.substr(help.find(heading) + heading.size()));
  std::vector<std::string> names;
  for (std::string line; std::getline(lines, line) && line.starts_with("  ");) {
    if (line[2] != ' ') names.push_back(line.substr(2, line.find(' ', 2) - 2));
  }
  return names;
}

}  // namespace prowl::test
