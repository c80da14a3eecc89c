#pragma once

#include <boost/timer/progress_display.hpp>
#include <optional>
#include <string>

namespace prowl::cli {

/// Shows on stderr how many of `total` equal pieces of work are done. In a terminal: the bar of
/// Boost.Timer, with elapsed and remaining time; elsewhere, or if too narrow: a line for every
/// tenth. Silent with --quiet.
class ProgressBar {
 public:
  enum class Opening { at_once, if_long };  ///< if_long: when the estimated total is two seconds or more

  /// `what`: plural name of the pieces, "simulations"; `total` > 0.
  ProgressBar(std::string what, int total, Opening opening = Opening::at_once);
  ~ProgressBar();  ///< closes an unfinished bar
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// `done` must not decrease; 0 shows the start. `note`: of the work so far, in ASCII; behind the times, if it has
  /// room.
  void show(int done, const std::string& note = "");

 private:
  bool is_long(int done) const;
  void open();
  void show_bar(int done, const std::string& note);
  void show_line(int done, const std::string& note);
  double seconds() const;  ///< since construction
  std::string times(int done) const;
  void write_behind(const std::string& text);

  std::string what_;
  int total_;
  double began_;  ///< in wall_seconds()
  std::optional<boost::timer::progress_display> bar_;
  std::size_t behind_ = 0;  ///< characters behind the bar
  int tenths_ = 0;          ///< number of tenths printed
  bool is_open_ = false;
};

/// Callback for simulate() and rollout(): a ProgressBar over the motion if it takes long.
class MotionProgress {
 public:
  void operator()(double t, double end);  ///< [s], from 0

 private:
  std::optional<ProgressBar> bar_;
};

}  // namespace prowl::cli
