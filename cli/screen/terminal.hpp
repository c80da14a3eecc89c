#pragma once

#include <cstddef>

namespace prowl::cli {

/// Columns of the terminal on stdout, at least 40; 80 without a terminal.
std::size_t columns();

/// The same, but without a limit if stdout is no terminal: programs may read the table.
std::size_t columns_of_table();

/// True if this stream (STDOUT_FILENO, STDERR_FILENO) is a terminal that is not dumb, and
/// NO_COLOR is not set (https://no-color.org).
bool has_colour(int stream);

}  // namespace prowl::cli
