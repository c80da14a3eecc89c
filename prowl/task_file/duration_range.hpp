#pragma once

// Internal to io.
#include "prowl/motion/duration_limits.hpp"
#include "prowl/task_file/toml/toml_value.hpp"

namespace prowl {

inline NumberRange duration_range() { return {.lower = kShortestPhase, .upper = kLongestMotion}; }

}  // namespace prowl
