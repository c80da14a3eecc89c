#include "prowl/terms/angle_ratio.hpp"

#include <cmath>

namespace prowl {

// Below, the differences of the closed forms lose digits to rounding: c'' has 1e-16 / u^2.
constexpr double kSmall = 0.03;

AngleRatio::AngleRatio(double x) {
  const double u = 1.0 - x;
  if (u > kSmall) {
    const double sin2 = u * (1.0 + x);  // sin²t
    value = std::acos(x) / std::sqrt(sin2);
    slope = (x * value - 1.0) / sin2;  // (1 - x²) c' = x c - 1
    curvature = (3.0 * x * slope + value) / sin2;
    return;
  }
  // c = sum a_k u^k with a_0 = 1, a_{k+1} = a_k (k + 1) / (2 k + 3): from that equation, with 1 - x² = 2 u - u².
  value = slope = curvature = 0.0;
  double coefficient = 1.0, power = 1.0, power1 = 0.0, power2 = 0.0;  // u^k, k u^(k-1), k (k-1) u^(k-2)
  for (int k = 0; k < 12; ++k) {
    value += coefficient * power;
    slope -= coefficient * power1;  // d/dx = -d/du
    curvature += coefficient * power2;
    coefficient *= (k + 1.0) / (2.0 * k + 3.0);
    power2 = power2 * u + 2.0 * power1;
    power1 = power1 * u + power;
    power *= u;
  }
}

}  // namespace prowl
