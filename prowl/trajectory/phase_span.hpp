#pragma once

#include <optional>

#include "prowl/trajectory/trajectory.hpp"

namespace prowl {

/// From the first node of a phase to its last [s].
struct PhaseSpan {
  double start = 0.0, end = 0.0;
};

/// Nothing where the motion has no node of the phase.
std::optional<PhaseSpan> phase_span(const Trajectory& trajectory, std::size_t phase);

}  // namespace prowl
