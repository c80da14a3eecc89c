#pragma once

#include <boost/timer/progress_display.hpp>
#include <chrono>
#include <optional>
#include <string>

namespace prowl::cli {

/// How many of `total` equal pieces of work are done, on stderr. In a terminal the bar of Boost.Timer with the time that has
/// passed and what is left at this pace; elsewhere, and where it is too narrow, a line for every tenth. No colours.
class ProgressBar {
 public:
  /// `what` there are `total` > 0 of: "simulations".
  ProgressBar(std::string what, int total);
  ~ProgressBar();  ///< ends a bar that is not full
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// `done` does not fall.
  void show(int done);

 private:
  void show_bar(int done);
  void show_line(int done);
  std::string times(int done) const;
  void write_behind(const std::string& text);

  std::string what_;
  int total_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::optional<boost::timer::progress_display> bar_;
  std::size_t behind_ = 0;  ///< characters behind the bar
  int tenths_ = 0;          ///< that have their line
};

}  // namespace prowl::cli
