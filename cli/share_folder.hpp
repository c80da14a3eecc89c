#pragma once

#include <filesystem>

#include "program_path.hpp"

namespace prowl::cli {

/// PREFIX/share/prowl for PREFIX/bin/prowl, installed as well as in a build.
inline std::filesystem::path share_folder() { return program_path().parent_path().parent_path() / "share/prowl"; }

}  // namespace prowl::cli
