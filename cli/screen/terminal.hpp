#pragma once

#include <cstddef>

namespace prowl::cli {

/// Columns of the terminal that stdout is, at least 40; 80 if it is none.
std::size_t columns();

/// The same; no limit if it is none, for tables that a program may read.
std::size_t columns_of_table();

/// Whether colours may be written to this stream (STDOUT_FILENO, STDERR_FILENO): it is a terminal that is not dumb, and
/// NO_COLOR is not set (https://no-color.org).
bool has_colour(int stream);

}  // namespace prowl::cli
