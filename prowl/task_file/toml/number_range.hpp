#pragma once

#include <limits>
#include <string>

namespace prowl {

/// Numbers that a key accepts, with a description. None exceeds kLargest in size, so sums and
/// products stay finite.
struct NumberRange {
  static constexpr double kLargest = 1e9;
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  bool above_lower = false;    ///< exclude lower itself
  const char* hint = "";       ///< appended to the range in messages
  std::string limits() const;  ///< "> 0", "from 1 to 10"; "" if unlimited
  bool contains(double value) const;
  double any_inside() const;  ///< some allowed number, to replace one out of range

  static NumberRange any() { return {}; }
  static NumberRange positive() { return {.lower = 0.0, .above_lower = true}; }
  static NumberRange nonnegative() { return {.lower = 0.0}; }
};

}  // namespace prowl
