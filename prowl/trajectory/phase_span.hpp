#pragma once

#include <optional>

#include "prowl/trajectory/trajectory.hpp"

namespace prowl {

/// Times of the first and the last node of a phase [s].
struct PhaseSpan {
  double start = 0.0, end = 0.0;
};

/// Nullopt if the motion has no node of the phase.
std::optional<PhaseSpan> phase_span(const Trajectory& trajectory, std::size_t phase);

}  // namespace prowl
