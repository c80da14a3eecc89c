#pragma once

#include <cmath>
#include <string>
#include <string_view>

namespace prowl {

/// Largest of the recorded values, with time and location; NaN counts as largest.
struct WorstMoment {
  bool empty = true;  ///< nothing was recorded
  double worst = 0.0;
  double time = 0.0;  ///< [s]
  std::string where;

  /// Returns whether it is the largest so far.
  bool record(double value, double at_time, std::string_view at) {
    if (!empty && (std::isnan(worst) || value <= worst)) return false;
    empty = false;
    worst = value;
    time = at_time;
    where = at;
    return true;
  }
};

}  // namespace prowl
