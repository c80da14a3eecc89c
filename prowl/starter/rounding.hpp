#pragma once

#include <cmath>

namespace prowl {

/// The nearest multiple of 0.01; 0, never -0.
inline double hundredths(double x) { return std::round(100.0 * x) / 100.0 + 0.0; }

}  // namespace prowl
