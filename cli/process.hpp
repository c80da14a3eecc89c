#pragma once

#include <string>
#include <vector>

namespace prowl::cli {

/// Runs a program with these arguments, without a shell, and waits for it; the first argument is the program, with its path.
/// What it prints goes where our messages go (stderr). Returns its exit status, 128 + N if signal N ended it.
/// Throws InputError if it cannot be started.
int run_program(const std::vector<std::string>& arguments);

}  // namespace prowl::cli
