#pragma once

#include <limits>
#include <string>

namespace prowl {

/// Numbers that a key accepts, and how to say it. None may be beyond kLargest: sums and products then stay finite.
struct NumberRange {
  static constexpr double kLargest = 1e9;
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  bool above_lower = false;    ///< lower itself is not allowed
  const char* hint = "";       ///< said after the range
  std::string limits() const;  ///< "> 0", "from 1 to 10"; "" if any number will do
  bool contains(double value) const;
  double any_inside() const;  ///< a number that is allowed, in place of one that is not

  static NumberRange any() { return {}; }
  static NumberRange positive() { return {.lower = 0.0, .above_lower = true}; }
  static NumberRange nonnegative() { return {.lower = 0.0}; }
};

}  // namespace prowl
