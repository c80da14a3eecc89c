#include "prowl/files/text_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <string_view>
#include <system_error>

#include "prowl/error.hpp"
#include "prowl/text/shown_text.hpp"

namespace prowl {

SourceText read_text_file(const std::filesystem::path& path, std::size_t max_bytes) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (status.type() == std::filesystem::file_type::not_found) {
    throw InputError(fmt::format("{}: no such file", path.string()));
  }
  if (error == std::errc::too_many_symbolic_link_levels || error == std::errc::filename_too_long) {
    throw InputError(fmt::format("{}: {}", shown(path.string()), error.message()));
  }
  if (error) throw FileError(fmt::format("{}: {}", path.string(), error.message()));
  // Refuses folders, and devices and pipes, from which a read may never return.
  if (status.type() != std::filesystem::file_type::regular) {
    throw InputError(fmt::format("{}: not a file", path.string()));
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) throw FileError(fmt::format("{}: cannot read: {}", path.string(), std::strerror(errno)));
  const auto bytes = std::filesystem::file_size(path, error);
  if (error) throw FileError(fmt::format("{}: cannot read: {}", path.string(), error.message()));
  if (bytes > max_bytes) {
    throw InputError(
        fmt::format("{}: {} bytes; need at most {}: is it the right file?", path.string(), bytes, max_bytes));
  }
  std::string text(static_cast<std::size_t>(bytes), '\0');
  if (!file.read(text.data(), static_cast<std::streamsize>(bytes))) {
    throw FileError(fmt::format("{}: cannot read: {}", path.string(), std::strerror(errno)));
  }
  return {path, std::move(text)};
}

std::string location_in(const SourceText& source, std::size_t at) {
  const std::string_view before = std::string_view(source.text).substr(0, at);
  const std::size_t line_start = before.rfind('\n') + 1;  // npos + 1 is 0
  return fmt::format("{}:{}:{}", source.path.string(), 1 + std::ranges::count(before, '\n'), at - line_start + 1);
}

}  // namespace prowl
