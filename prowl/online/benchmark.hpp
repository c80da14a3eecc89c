#pragma once

#include <string>
#include <vector>

#include "prowl/online/online_run.hpp"

namespace prowl {

/// Runs that differ by their seed only.
struct BenchmarkRow {
  std::string name;
  std::string meaning;    ///< in words
  int seeds = 1;          ///< number of runs
  bool is_alone = false;  ///< runs by itself on the machine: its computing times count
  double kick = 0.0;      ///< size of its kicks [m/s]
  double pendulum = 0.0;  ///< largest kick of a linear pendulum with the legs' reach [m/s], if there are kicks
  OnlineOptions options;
  enum class Events { none, commands, kicks, one_kick } events = Events::none;

  /// Options of the run with this seed, on which kicks and commands depend, too.
  OnlineOptions run(const RobotModel& robot, std::uint64_t seed) const;
};

/// The rows of `prowl mpc --benchmark`: computing times, random commands, kicks, an unknown load, slippery and sloping
/// ground, an hour (docs/online-benchmark.md). `base`: what all have in common, e.g. weights.
std::vector<BenchmarkRow> benchmark_rows(const RobotModel& robot, const OnlineOptions& base);

}  // namespace prowl
