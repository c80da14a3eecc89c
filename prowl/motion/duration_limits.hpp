#pragma once

namespace prowl {

// Limits for task files and for changes that a diagnosis proposes.
/// Longest motion, and so phase [s]: the certificate checks each millisecond, and a larger number is probably in
/// milliseconds.
constexpr double kLongestMotion = 600.0;
/// Shortest phase [s]: a control cycle.
constexpr double kShortestPhase = 1e-3;

}  // namespace prowl
