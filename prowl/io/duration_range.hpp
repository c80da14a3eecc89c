#pragma once

// Internal to io.
#include "prowl/io/toml_value.hpp"
#include "prowl/motion/duration_limits.hpp"

namespace prowl {

inline NumberRange duration_range() { return {.lower = kShortestPhase, .upper = kLongestMotion}; }

}  // namespace prowl
