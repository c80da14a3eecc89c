#include "cli/process/program_files.hpp"

namespace prowl::cli {

std::filesystem::path program_path() {
  std::error_code ignored;
  return std::filesystem::read_symlink("/proc/self/exe", ignored);
}

std::filesystem::path share_folder() { return program_path().parent_path().parent_path() / "share/prowl"; }

PackageSearch package_search(const std::vector<std::string>& package_dirs) {
  return prowl::package_search(program_path(), package_dirs);
}

std::string find_task(const std::string& name) {
  std::error_code ignored;
  if (std::filesystem::exists(name, ignored)) return name;
  for (const std::filesystem::path& folder : {share_folder(), package_search({}).clone}) {
    const std::filesystem::path shipped = folder / "tasks" / (name + ".toml");
    if (std::filesystem::is_regular_file(shipped, ignored)) return shipped.string();
  }
  return name;
}

}  // namespace prowl::cli
