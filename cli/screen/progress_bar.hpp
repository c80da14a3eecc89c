#pragma once

#include <boost/timer/progress_display.hpp>
#include <optional>
#include <string>

namespace prowl::cli {

/// How many of `total` equal pieces of work are done, on stderr. In a terminal the bar of Boost.Timer with the time
/// that has passed and what is left at this pace; elsewhere, and where it is too narrow, a line for every tenth. No
/// colours. Nothing with --quiet.
class ProgressBar {
 public:
  enum class Start { at_once, if_long };  ///< if_long: once it looks as if all will take two seconds or more

  /// `what` there are `total` > 0 of: "simulations".
  ProgressBar(std::string what, int total, Start start = Start::at_once);
  ~ProgressBar();  ///< ends a bar that is not full
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// `done` does not fall; 0 shows that it has begun.
  void show(int done);

 private:
  bool is_long(int done) const;
  void open();
  void show_bar(int done);
  void show_line(int done);
  double seconds() const;  ///< since it was made
  std::string times(int done) const;
  void write_behind(const std::string& text);

  std::string what_;
  int total_;
  double start_;  ///< in wall_seconds()
  std::optional<boost::timer::progress_display> bar_;
  std::size_t behind_ = 0;  ///< characters behind the bar
  int tenths_ = 0;          ///< that have their line
  bool is_open_ = false;
};

/// Progress of a simulation or a rollout, as simulate() and rollout() call it: a ProgressBar over the motion if it
/// takes long.
class MotionProgress {
 public:
  void operator()(double t, double end);  ///< [s], from 0

 private:
  std::optional<ProgressBar> bar_;
};

}  // namespace prowl::cli
