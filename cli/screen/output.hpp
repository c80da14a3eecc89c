#pragma once

#include <string>

namespace prowl::cli {

/// Gives a closed stdin, stdout or stderr something to stand for it. Else the next file to be opened gets its number,
/// and messages are written into a plan. Call first.
void open_standard_streams();

/// Writes a result to stdout, control characters of names and texts in it written out (printable()), with colours if it
/// is a terminal (paint()). Throws FileError if it does not get through (a full disk behind a redirection).
void print_result(const std::string& text);
/// The same for a program to read, as it is.
void print_bytes(const std::string& text);

/// Writes a message to stderr as far as that goes: nobody has to listen, and no plan fails for it. Control characters
/// and colours as above; draw() leaves all as it is, for a bar.
void print_message(const std::string& text);
void print_note(const std::string& text);  ///< print_message() of a line that begins with "note: "
void draw(const std::string& text) noexcept;

/// print_message() of what says only how far the work is; nothing after be_quiet().
void print_progress(const std::string& text);
void be_quiet();  ///< --quiet
bool is_quiet();

}  // namespace prowl::cli
