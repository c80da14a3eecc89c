#pragma once

namespace prowl {

// Of a motion that is for a user: task files, and what a diagnosis proposes.
/// Of a motion, and so of each of its phases [s]: the certificate looks at each millisecond, and who writes more writes
/// milliseconds.
constexpr double kLongestMotion = 600.0;
/// Of a phase [s]: a control cycle.
constexpr double kShortestPhase = 1e-3;

}  // namespace prowl
