#include "output.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "prowl/error.hpp"

namespace prowl::cli {

void print_result(const std::string& text) {
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  if (!written || std::fflush(stdout) != 0) throw FileError(std::string("standard output: ") + std::strerror(errno));
}

}  // namespace prowl::cli
