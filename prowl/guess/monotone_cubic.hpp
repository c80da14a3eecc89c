#pragma once

#include <optional>
#include <vector>

namespace prowl {

/// A point that a curve goes through.
struct Waypoint {
  double time = 0.0;  ///< [s]
  double value = 0.0;
  std::optional<double> slope;  ///< if not given, the curve chooses it
};

/// Piecewise cubic through waypoints that does not overshoot them: between two waypoints it stays between their values
/// (as long as given slopes allow). At rest at both ends unless their slopes are given, constant beyond them.
///
/// Fritsch, Butland, "A method for constructing local monotone piecewise cubic interpolants", 1984: inside, the slope
/// is the weighted harmonic mean of the two secants, and zero where they differ in sign.
class MonotoneCubic {
 public:
  /// At least one waypoint, times strictly increasing.
  explicit MonotoneCubic(const std::vector<Waypoint>& waypoints);

  double operator()(double time) const;

 private:
  std::vector<double> times_, values_, slopes_;
};

}  // namespace prowl
