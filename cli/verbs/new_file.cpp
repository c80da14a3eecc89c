#include "cli/verbs/new_file.hpp"

#include <fmt/format.h>

#include "prowl/error.hpp"
#include "prowl/files/atomic_folder.hpp"

namespace prowl::cli {

namespace fs = std::filesystem;

void add_new_file(CLI::App& verb, NewFileOptions& options, const std::string& fallback) {
  verb.add_option("--out", options.out, "File to write; default " + fallback)->type_name("FILE.toml");
  verb.add_flag("--force", options.force, "Replace an existing file");
}

void check_new_file(const fs::path& file, bool force) {
  std::error_code error;
  if (fs::is_directory(file, error)) throw InputError(fmt::format("{}: is a folder; need a file name", file.string()));
  if (fs::exists(file, error) && !force) {
    throw InputError(fmt::format("{}: exists already; --force replaces it, --out FILE writes another", file.string()));
  }
}

void write_new_file(const fs::path& file, const std::string& text) {
  std::error_code error;
  if (file.has_parent_path() && (fs::create_directories(file.parent_path(), error), error)) {
    throw FileError(fmt::format("{}: cannot be created: {}", file.parent_path().string(), error.message()));
  }
  write_file_atomically(file, text);
}

}  // namespace prowl::cli
