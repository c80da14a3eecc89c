#pragma once

#include <string>

namespace prowl::cli {

/// Gives a closed stdin, stdout or stderr something to stand for it. Else the next file to be opened gets its number,
/// and messages are written into a plan. Call first.
void open_standard_streams();

/// Writes a result to stdout. Throws FileError if it does not get through (a full disk behind a redirection).
void print_result(const std::string& text);

/// Writes a message to stderr as far as that goes: nobody has to listen, and no plan fails for it.
void print_message(const std::string& text) noexcept;

/// The same for what says only how far the work is; nothing after be_quiet().
void print_progress(const std::string& text) noexcept;
void be_quiet();  ///< --quiet
bool is_quiet();

}  // namespace prowl::cli
