#include "cli/screen/terminal.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <string_view>

namespace prowl::cli {
namespace {

std::string_view environment(const char* name) {
  const char* const value = std::getenv(name);
  return value ? value : "";
}

}  // namespace

std::size_t columns() {
  constexpr std::size_t kUsual = 80, kFewest = 40;
  winsize size{};
  if (::isatty(STDOUT_FILENO) != 1 || ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return kUsual;
  return std::max<std::size_t>(size.ws_col, kFewest);
}

std::size_t columns_of_table() {
  return ::isatty(STDOUT_FILENO) == 1 ? columns() : std::numeric_limits<std::size_t>::max();
}

bool has_colour(int stream) {
  return ::isatty(stream) == 1 && environment("NO_COLOR").empty() && environment("TERM") != "dumb";
}

}  // namespace prowl::cli
