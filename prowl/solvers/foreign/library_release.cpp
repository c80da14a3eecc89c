#include "prowl/solvers/foreign/library_release.hpp"

#include <fmt/format.h>

#include <set>
#include <sstream>

namespace prowl {
namespace {

/// "3.14" of "3.14.19".
std::string release(const std::string& version) {
  const std::size_t first = version.find('.');
  return version.substr(0, first == std::string::npos ? first : version.find('.', first + 1));
}

std::set<std::string> words(const std::string& text) {
  std::istringstream stream(text);
  std::set<std::string> all;
  for (std::string word; stream >> word;) all.insert(word);
  return all;
}

}  // namespace

std::optional<std::string> why_other_release(const std::string& library, const std::string& loaded,
                                             const std::string& built, const std::string& file) {
  if (release(loaded) == release(built)) return std::nullopt;
  return fmt::format(
      "{} is {} {}, and this Prowl was built with {} {}: remove its folder from LD_LIBRARY_PATH, or install "
      "the pinned wheels and build again (scripts/setup)",
      file, library, loaded, library, built);
}

std::optional<std::string> why_missing_instructions(const std::string& library, const std::string& needs,
                                                    const std::string& has) {
  const std::set<std::string> there = words(has);
  std::string missing;
  for (const std::string& word : words(needs)) {
    if (!there.contains(word)) missing += (missing.empty() ? "" : ", ") + word;
  }
  if (missing.empty()) return std::nullopt;
  return fmt::format("{} needs a processor with {}, which this one lacks", library, missing);
}

}  // namespace prowl
