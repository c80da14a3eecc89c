#include "cli/process/program_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "prowl/error.hpp"
#include "prowl/text/nearest_name.hpp"
#include "prowl/text/shown_text.hpp"

namespace prowl::cli {

std::filesystem::path program_path() {
  std::error_code ignored;
  return std::filesystem::read_symlink("/proc/self/exe", ignored);
}

std::filesystem::path share_folder() { return program_path().parent_path().parent_path() / "share/prowl"; }

PackageSearch package_search(const std::vector<std::string>& package_dirs) {
  return prowl::package_search(program_path(), package_dirs);
}

namespace {

/// In folders of the share, "tasks" or "robots"; `what`: one of them in words.
std::string find_shipped(const std::string& name, const char* kind, const char* what) {
  std::error_code unknown;  // told by the reader
  if (std::filesystem::exists(name, unknown) || unknown) return name;
  std::vector<std::string> shipped;
  for (const std::filesystem::path& share : {share_folder(), package_search({}).clone}) {
    const std::filesystem::path folder = share / kind, file_of_name = folder / (name + ".toml");
    if (std::filesystem::is_regular_file(file_of_name, unknown)) return file_of_name.string();
    for (const auto& file : std::filesystem::recursive_directory_iterator(folder, unknown)) {
      if (file.path().extension() == ".toml")
        shipped.push_back(file.path().lexically_relative(folder).replace_extension());
    }
  }
  std::ranges::sort(shipped);
  const bool is_path = name.ends_with(".toml");  // of a file of the user's own, probably
  if (is_path || shipped.empty()) return name;
  throw InputError(fmt::format("{}: no such file, and no shipped {} of that name{}", shown(name), what,
                               did_you_mean(name, shipped)));
}

}  // namespace

std::string find_task(const std::string& name) { return find_shipped(name, "tasks", "task"); }

std::string find_robot(const std::string& name) { return find_shipped(name, "robots", "robot"); }

}  // namespace prowl::cli
