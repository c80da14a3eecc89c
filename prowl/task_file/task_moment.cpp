#include "prowl/task_file/task_moment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace prowl {
namespace {

struct NodeTime {
  PhaseFraction at;
  double time;  ///< [s]
};

/// All nodes except the start; at a phase transition only the earlier node.
std::vector<NodeTime> node_times(const std::vector<Phase>& phases, const Mesh& mesh) {
  std::vector<NodeTime> nodes;
  double begin = 0.0;
  for (int p = 0; p < static_cast<int>(phases.size()); ++p) {
    const double duration = phases[p].duration.min;
    for (int k = 1; k <= mesh.phases[p].intervals(); ++k) {
      nodes.push_back({{p, mesh.phases[p].node_time(k, 1.0)}, begin + mesh.phases[p].node_time(k, duration)});
    }
    begin += duration;
  }
  return nodes;
}

PhaseFraction moment_at_time(const TomlValue& value, double time, const std::vector<Phase>& phases,
                             const std::optional<Mesh>& mesh) {
  constexpr double kSameTime = 1e-6;  // [s]; decimal fractions in files are not exact node times
  const Mesh ends{std::vector(phases.size(), PhaseMesh(1))};
  const std::vector<NodeTime> nodes = node_times(phases, mesh.value_or(ends));
  const auto after =
      std::find_if(nodes.begin(), nodes.end(), [&](const NodeTime& n) { return n.time >= time - kSameTime; });
  if (after == nodes.end()) {
    value.fail(fmt::format("{:g} is after the end; need 0 < time <= {:g} [s]", time, nodes.back().time));
  }
  if (after->time <= time + kSameTime) return after->at;
  if (!mesh) {
    const double left = after->time - time;
    return {after->at.phase, 1.0 - left / phases[after->at.phase].duration.min};
  }
  if (after == nodes.begin()) {
    value.fail(
        fmt::format("{:g} is not at a node of the mesh; the first after the start is {:.6g} [s]", time, after->time));
  }
  value.fail(fmt::format("{:g} is not at a node of the mesh; the nearest are {:.6g} and {:.6g} [s]", time,
                         std::prev(after)->time, after->time));
}

/// Fraction of the phase at the node there.
double fraction_at_node(const TomlValue& value, double fraction, const PhaseMesh& mesh) {
  constexpr double kRounding = 1e-6;  // a decimal fraction in a file is not an exact node
  const int intervals = mesh.intervals();
  const double node = fraction * intervals;
  if (std::abs(node - std::round(node)) > kRounding * intervals) {
    value.fail(fmt::format("not at a node of the mesh; the nearest are {:.6g} and {:.6g}", std::floor(node) / intervals,
                           std::ceil(node) / intervals));
  }
  return mesh.node_time(static_cast<int>(std::lround(node)), 1.0);
}

/// Keys that say when.
struct WhenKeys {
  std::optional<TomlValue> time, phase, fraction;
};

WhenKeys when_keys(const TomlTable& table, const std::vector<Phase>& phases) {
  const WhenKeys keys{table.find("time_s"), table.find("phase"), table.find("fraction")};
  if (keys.time && keys.phase) keys.phase->fail("need either time_s or phase, not both");
  if (keys.fraction && !keys.phase) keys.fraction->fail("needs the key phase");
  if (!keys.time) return keys;
  for (const Phase& phase : phases) {
    if (phase.duration.is_fixed()) continue;
    keys.time->fail("the duration of phase '" + phase.name + "' is free: need phase, not time_s");
  }
  return keys;
}

int phase_index(const TomlValue& value, const std::vector<Phase>& phases) {
  std::vector<std::string> names;
  for (const Phase& phase : phases) names.push_back(phase.name);
  const auto found = std::find(names.begin(), names.end(), value.as_text());
  if (found == names.end()) value.fail_unknown_name("phase", names);
  return static_cast<int>(found - names.begin());
}

}  // namespace

PhaseFraction read_moment(const TomlTable& table, const std::vector<Phase>& phases, const std::optional<Mesh>& mesh) {
  const auto [time, phase, fraction] = when_keys(table, phases);
  if (time) return moment_at_time(*time, time->as_number(), phases, mesh);
  if (!phase) return PhaseFraction::end_of(static_cast<int>(phases.size()) - 1);
  const int index = phase_index(*phase, phases);
  if (!fraction) return PhaseFraction::end_of(index);
  return {index,
          mesh ? fraction_at_node(*fraction, fraction->as_number(), mesh->phases[index]) : fraction->as_number()};
}

MotionSpan read_span(const TomlTable& table, const std::vector<Phase>& phases, const std::optional<Mesh>& mesh) {
  const WhenKeys when = when_keys(table, phases);
  if (when.time) {
    const TomlBounds span = when.time->as_range();
    const auto at = [&](double seconds) {
      return seconds == 0.0 ? PhaseFraction::start_of(0) : moment_at_time(*when.time, seconds, phases, mesh);
    };
    return {at(span.lower), at(span.upper)};
  }
  if (!when.phase) return {PhaseFraction::start_of(0), PhaseFraction::end_of(static_cast<int>(phases.size()) - 1)};
  const int index = phase_index(*when.phase, phases);
  if (!when.fraction) return {PhaseFraction::start_of(index), PhaseFraction::end_of(index)};
  const TomlBounds span = when.fraction->as_range();
  const auto at = [&](double part) {
    return PhaseFraction{index, mesh ? fraction_at_node(*when.fraction, part, mesh->phases[index]) : part};
  };
  return {at(span.lower), at(span.upper)};
}

}  // namespace prowl
