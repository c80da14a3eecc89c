#pragma once

#include <filesystem>
#include <string>

namespace prowl {

/// A text and its file; plans keep a copy of their input files in this form.
struct SourceText {
  std::filesystem::path path;
  std::string text;
};

/// The whole file. Throws InputError if it does not exist or exceeds `max_bytes`, FileError if it cannot be read.
SourceText read_text_file(const std::filesystem::path& path, std::size_t max_bytes = 1u << 20);

/// "file:line:column" of byte `at`, 0 to the size of the text.
std::string location_in(const SourceText& source, std::size_t at);

}  // namespace prowl
