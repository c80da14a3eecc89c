#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>

namespace prowl::cli {

struct NewFileOptions {
  std::string out;  ///< "": default of the verb
  bool force = false;
};

/// --out and --force; `fallback`: default of --out in words.
void add_new_file(CLI::App& verb, NewFileOptions& options, const std::string& fallback);

/// Throws InputError if the file exists, unless `force`.
void check_new_file(const std::filesystem::path& file, bool force);

/// Creates the folder, too. Throws FileError; an old file then stays unchanged.
void write_new_file(const std::filesystem::path& file, const std::string& text);

}  // namespace prowl::cli
