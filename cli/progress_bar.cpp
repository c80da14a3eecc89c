#include "progress_bar.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "output.hpp"

namespace prowl::cli {
namespace {

constexpr int kNarrowest = 76;  // columns that bar and times take

/// A terminal that is wide enough: the times are overwritten by going back, which does not work over the end of a line.
bool has_room() {
  if (::isatty(STDERR_FILENO) != 1) return false;
  winsize size{};
  return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0 || size.ws_col >= kNarrowest;
}

std::string clock(double seconds) {
  const std::chrono::seconds whole(std::lround(seconds));
  return whole < std::chrono::hours(1) ? fmt::format("{:%M:%S}", whole) : fmt::format("{:%T}", whole);
}

}  // namespace

ProgressBar::ProgressBar(std::string what, int total) : what_(std::move(what)), total_(total) {
  if (has_room()) bar_.emplace(static_cast<unsigned long>(total), std::cerr, fmt::format("{} {}\n", total, what_));
}

ProgressBar::~ProgressBar() {
  if (bar_ && bar_->count() < bar_->expected_count()) print_message("\n");
}

void ProgressBar::show(int done) {
  if (bar_) {
    show_bar(done);
  } else {
    show_line(done);
  }
}

void ProgressBar::show_bar(int done) {
  const unsigned long more = static_cast<unsigned long>(done) - bar_->count();
  if (more == 0) return;  // it would draw a tic all the same
  write_behind("");
  *bar_ += more;
  if (done < total_) {
    write_behind("  " + times(done));
  } else {
    print_message(fmt::format("{} {}: {}\n", done, what_, times(done)));  // it has ended its line
  }
}

void ProgressBar::show_line(int done) {
  const int tenths = static_cast<int>(10L * done / total_);
  if (tenths == tenths_) return;
  tenths_ = tenths;
  print_message(fmt::format("{} of {} {}: {}\n", done, total_, what_, times(done)));
}

std::string ProgressBar::times(int done) const {
  const double passed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  if (done == total_) return clock(passed);
  return fmt::format("{}, {} left", clock(passed), clock(passed * (total_ - done) / done));
}

/// Puts text behind the bar in place of what stood there, and goes back to where the bar goes on.
void ProgressBar::write_behind(const std::string& text) {
  const std::size_t width = std::max(text.size(), behind_);
  print_message(fmt::format("{:<{}}{:\b<{}}", text, width, "", width));
  behind_ = text.size();
}

}  // namespace prowl::cli
