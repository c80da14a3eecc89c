#pragma once

#include <string>

namespace prowl::cli {

/// Writes a result to stdout. Throws FileError if it does not get through (a full disk behind a redirection).
void print_result(const std::string& text);

}  // namespace prowl::cli
