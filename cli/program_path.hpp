#pragma once

#include <filesystem>

namespace prowl::cli {

/// The file that this code was loaded from: the command, or the Python module, each with a definition of its own.
std::filesystem::path program_path();

}  // namespace prowl::cli
