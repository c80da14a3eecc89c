#include "cli/process/work_folder.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>

#include "prowl/error.hpp"

namespace prowl::cli {

namespace fs = std::filesystem;

WorkFolder::WorkFolder() {
  std::string name = (fs::temp_directory_path() / "prowl_XXXXXX").string();
  if (!::mkdtemp(name.data())) throw FileError(fmt::format("{}: cannot make this folder", name));
  path_ = name;
}

WorkFolder::~WorkFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

}  // namespace prowl::cli
