#pragma once

// Reads when goals and terms hold: time_s, or phase with fraction. Not installed: exposes toml++.
#include <optional>
#include <vector>

#include "prowl/mesh/mesh.hpp"
#include "prowl/motion/phase.hpp"
#include "prowl/task_file/toml/toml_value.hpp"

namespace prowl {

/// One moment, the end of the motion by default. With a mesh, which has equal steps in each phase, it must be at a
/// node.
PhaseFraction read_moment(const TomlTable& table, const std::vector<Phase>& phases, const std::optional<Mesh>& mesh);

/// First and last moment, equal for one moment.
struct MotionSpan {
  PhaseFraction from, to;
};

/// One moment for a number; a span for [min, max] or a phase; by default the whole motion. With a mesh, both ends must
/// be at nodes.
MotionSpan read_span(const TomlTable& table, const std::vector<Phase>& phases, const std::optional<Mesh>& mesh);

}  // namespace prowl
