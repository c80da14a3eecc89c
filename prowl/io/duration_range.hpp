#pragma once

// Internal to io.
#include "prowl/io/toml_value.hpp"

namespace prowl {

/// Of a motion, and so of each of its phases [s]: the certificate looks at each millisecond, and who writes more writes milliseconds.
constexpr double kLongestMotion = 600.0;
/// Of a phase [s]: a control cycle.
constexpr double kShortestPhase = 1e-3;

inline NumberRange duration_range() {
  return {.lower = kShortestPhase, .upper = kLongestMotion};
}

}  // namespace prowl
