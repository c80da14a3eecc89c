#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>

namespace prowl::cli {

struct NewFileOptions {
  std::string out;  ///< "": where the verb puts it
  bool force = false;
};

/// --out and --force; `fallback` is where it goes without --out, in words.
void add_new_file(CLI::App& verb, NewFileOptions& options, const std::string& fallback);

/// Throws InputError if there is a file already and it is not to be replaced.
void check_new_file(const std::filesystem::path& file, bool force);

/// Makes the folder too. Throws FileError, and then an old file is as it was.
void write_new_file(const std::filesystem::path& file, const std::string& text);

}  // namespace prowl::cli
