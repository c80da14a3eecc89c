#include "cli/screen/progress_bar.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <string_view>

#include "cli/screen/output.hpp"
#include "prowl/nlp/stopwatch.hpp"

namespace prowl::cli {
namespace {

constexpr int kNarrowest = 76;  // columns for bar and times
constexpr int kBar = 52;        // columns for the bar alone

/// Columns of the terminal; kNarrowest if it does not tell.
int terminal_columns() {
  winsize size{};
  return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0 ? kNarrowest : size.ws_col;
}

/// True for a terminal that is wide enough: times are overwritten by backspaces, which stop at the
/// start of a line.
bool has_room() {
  if (::isatty(STDERR_FILENO) != 1) return false;
  const char* const terminal = std::getenv("TERM");
  if (terminal && std::string_view(terminal) == "dumb") return false;  // it may lack backspace
  return terminal_columns() >= kNarrowest;
}

std::string with_note(const std::string& text, const std::string& note) {
  return note.empty() ? text : text + "; " + note;
}

std::string clock(double seconds) {
  const std::chrono::seconds whole(std::lround(seconds));
  return whole < std::chrono::hours(1) ? fmt::format("{:%M:%S}", whole) : fmt::format("{:%T}", whole);
}

}  // namespace

ProgressBar::ProgressBar(std::string what, int total, Opening opening)
    : what_(std::move(what)), total_(total), began_(wall_seconds()) {
  if (opening == Opening::at_once) open();
}

void ProgressBar::open() {
  if (is_quiet()) return;
  is_open_ = true;
  if (has_room()) bar_.emplace(static_cast<unsigned long>(total_), std::cerr, fmt::format("{} {}\n", total_, what_));
}

ProgressBar::~ProgressBar() {
  if (bar_ && bar_->count() < bar_->expected_count()) print_message("\n");
}

/// Extrapolates from the pace, after kFirstLook.
bool ProgressBar::is_long(int done) const {
  constexpr double kLong = 2.0, kFirstLook = 0.3;  // [s]
  const double passed = seconds();
  return passed >= kFirstLook && done < total_ && passed * total_ >= kLong * done;
}

void ProgressBar::show(int done, const std::string& note) {
  if (is_quiet()) return;
  if (!is_open_ && is_long(done)) open();
  if (!is_open_ || done == 0) return;
  if (bar_) {
    show_bar(done, note);
  } else {
    show_line(done, note);
  }
}

void ProgressBar::show_bar(int done, const std::string& note) {
  const unsigned long more = static_cast<unsigned long>(done) - bar_->count();
  if (more == 0) return;  // it would draw a tick anyway
  write_behind("");
  *bar_ += more;
  if (done < total_) {
    const std::string behind = "  " + times(done), all = with_note(behind, note);
    write_behind(kBar + std::ssize(all) <= terminal_columns() ? all : behind);
  } else {
    print_message(fmt::format("{} {}: {}\n", done, what_, with_note(times(done), note)));  // the bar has ended its line
  }
}

void ProgressBar::show_line(int done, const std::string& note) {
  const int tenths = static_cast<int>(10L * done / total_);
  if (tenths == tenths_) return;
  tenths_ = tenths;
  print_message(fmt::format("{} of {} {}: {}\n", done, total_, what_, with_note(times(done), note)));
}

double ProgressBar::seconds() const { return wall_seconds() - began_; }

std::string ProgressBar::times(int done) const {
  const double passed = seconds();
  if (done == total_) return clock(passed);
  return fmt::format("{}, {} left", clock(passed), clock(passed * (total_ - done) / done));
}

/// Replaces the text behind the bar, and moves the cursor back to the bar.
void ProgressBar::write_behind(const std::string& text) {
  const std::size_t width = std::max(text.size(), behind_);
  draw(fmt::format("{:<{}}{:\b<{}}", text, width, "", width));
  behind_ = text.size();
}

void MotionProgress::operator()(double t, double end) {
  const auto milliseconds = [](double seconds) { return static_cast<int>(std::lround(1e3 * seconds)); };
  const int total = std::max(1, milliseconds(end));
  if (!bar_) bar_.emplace("ms of motion", total, ProgressBar::Opening::if_long);
  bar_->show(std::clamp(milliseconds(t), 0, total));
}

}  // namespace prowl::cli
