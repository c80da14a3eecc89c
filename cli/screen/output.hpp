#pragma once

#include <string>

namespace prowl::cli {

/// Replaces a closed stdin, stdout or stderr; otherwise the next opened file gets its number, and
/// messages end up in a plan. Call it first.
void open_standard_streams();

/// Writes a result to stdout, with control characters escaped (printable()) and colours on a
/// terminal (paint()). Throws FileError if writing fails (a full disk behind a redirection).
void print_result(const std::string& text);
/// The same for programs, unchanged.
void print_bytes(const std::string& text);

/// Writes a message to stderr, with control characters and colours as above; ignores failures.
/// draw() writes unchanged text, for a bar.
void print_message(const std::string& text);
void print_note(const std::string& text);  ///< print_message() of a line "note: ..."
void draw(const std::string& text) noexcept;

/// print_message() for progress; silent after be_quiet().
void print_progress(const std::string& text);
void be_quiet();  ///< --quiet
bool is_quiet();

}  // namespace prowl::cli
