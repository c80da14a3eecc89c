#include "prowl/starter/packaged_robots.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <vector>

#include "prowl/error.hpp"
#include "prowl/text/nearest_name.hpp"

namespace prowl {

namespace fs = std::filesystem;

std::map<std::string, std::string> packaged_robots(const PackageSearch& search) {
  const std::string package = "package://example-robot-data/";
  fs::path folder;
  try {
    folder = resolve_uri(package + "package.xml", search.working_directory / "robot.toml", {}, search).parent_path();
  } catch (const InputError&) {  // not installed
    return {};
  }
  std::map<std::string, std::string> robots;
  std::error_code error;
  for (fs::recursive_directory_iterator entry(folder / "robots", error), end; !error && entry != end;
       entry.increment(error)) {
    if (entry->path().extension() != ".urdf") continue;
    robots.emplace(entry->path().stem().string(), package + entry->path().lexically_relative(folder).generic_string());
  }
  return robots;
}

std::string nearest_packaged_robot(const std::string& wrong, const PackageSearch& search) {
  const std::map<std::string, std::string> robots = packaged_robots(search);
  if (robots.empty()) return "";
  std::vector<std::string> names;
  for (const auto& [name, uri] : robots) names.push_back(name);
  const std::string nearest = nearest_name(fs::path(wrong).stem().string(), names);
  return fmt::format("; did you mean {}? Packaged robots: {}", robots.at(nearest), fmt::join(names, ", "));
}

}  // namespace prowl
