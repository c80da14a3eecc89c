#pragma once

#include <functional>
#include <string>
#include <vector>

namespace prowl::cli {

/// Runs a program without a shell and waits for it; the first argument is the program, searched in
/// PATH unless it is a path. `on_line` receives every line of its stdout; its stderr is ours.
/// Returns its exit status, or 128 + N after signal N. Throws InputError if it cannot start.
int run_program(const std::vector<std::string>& arguments, const std::function<void(const std::string& line)>& on_line);

}  // namespace prowl::cli
