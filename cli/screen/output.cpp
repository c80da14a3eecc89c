#include "cli/screen/output.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "cli/process/interrupt.hpp"
#include "cli/screen/paint.hpp"
#include "cli/screen/terminal.hpp"
#include "prowl/error.hpp"
#include "prowl/text/shown_text.hpp"

namespace prowl::cli {
namespace {

bool quiet = false;

}  // namespace

void open_standard_streams() {
  for (const int number : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(number, F_GETFD) != -1) continue;
    // Results on a closed stdout must fail, hence read-only; messages on a closed stderr must not.
    // open() returns the lowest free number: this one.
    [[maybe_unused]] const int same = ::open("/dev/null", number == STDERR_FILENO ? O_WRONLY : O_RDONLY);
  }
}

void print_result(const std::string& text) {
  const std::string shown = printable(text);
  print_bytes(has_colour(STDOUT_FILENO) ? paint(shown) : shown);
}

void print_bytes(const std::string& text) {
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  if (std::fflush(stdout) == 0 && written) return;
  const int reason = errno;
  const bool nobody_reads = is_terminal_gone() && (reason == EIO || reason == EPIPE);
  if (!nobody_reads) throw FileError(std::string("standard output: ") + std::strerror(reason));
}

void print_message(const std::string& text) {
  const std::string shown = printable(text);
  draw(has_colour(STDERR_FILENO) ? paint(shown) : shown);
}

void print_note(const std::string& text) { print_message("note: " + text + "\n"); }

void draw(const std::string& text) noexcept {
  [[maybe_unused]] const std::size_t written = std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

void print_progress(const std::string& text) {
  if (!quiet) print_message(text);
}

void be_quiet() { quiet = true; }

bool is_quiet() { return quiet; }

}  // namespace prowl::cli
