#pragma once

#include <functional>
#include <string>
#include <vector>

namespace prowl::cli {

/// Runs a program with these arguments, without a shell, and waits for it; the first argument is the program, looked
/// for in PATH if it has no path. `on_line` gets every line that it prints; what it says on stderr goes where our
/// messages go. Returns its exit status, 128 + N if signal N ended it. Throws InputError if it cannot be started.
int run_program(const std::vector<std::string>& arguments, const std::function<void(const std::string& line)>& on_line);

}  // namespace prowl::cli
