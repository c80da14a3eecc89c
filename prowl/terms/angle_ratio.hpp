#pragma once

namespace prowl {

/// c(x) = t / sin t with cos t = x: turns the sine part of a rotation into its rotation vector. With derivatives, for
/// -1 < x <= 1, or slightly more by rounding.
struct AngleRatio {
  double value = 1.0, slope = 0.0, curvature = 0.0;

  explicit AngleRatio(double x);
};

}  // namespace prowl
