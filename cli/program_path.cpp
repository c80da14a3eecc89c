#include "program_path.hpp"

namespace prowl::cli {

std::filesystem::path program_path() {
  std::error_code ignored;
  return std::filesystem::read_symlink("/proc/self/exe", ignored);
}

}  // namespace prowl::cli
